//! Drape: a round specimen on Cusick's disc in each fabric, and a tablecloth over a rectangular table at several samplings.

mod cloth;
mod cusick;
mod shadow;
mod tablecloth;

pub use cloth::DrapeError;
pub use cusick::{CusickRow, SPACINGS_MM, cusick, published_band};
pub use tablecloth::{TableclothRow, TableclothStudy, VARIANTS, tablecloth};
