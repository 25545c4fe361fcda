//! The byte form of a baked garment: versioned, checked, and the same on every platform.
//!
//! Layout: [`MAGIC`], [`VERSION`] (u32), the length of the body in bytes (u64), the body, and FNV-1a over the body (u64). All
//! numbers are little-endian. In the body each field follows the one before it, in the order of its struct; arrays and texts
//! begin with their length (u64), options with 0 or 1, enums are the number of their variant.

use std::ops::Range;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use thiserror::Error;

use super::baked::Garment;
use super::bend_friction::{BendFriction, FrictionSlot};
use super::check::LayoutError;
use super::data::GarmentData;
use super::direction::Direction;
use super::layout::{
    Bends, BundleRow, ConstraintRun, ConstraintSet, DiagonalShare, Diagonals, FiberBundle, FiberList, FiberLists,
    Fibers, HubGroup, Hubs, Layout, Links, OwnerShare, Tethers, Tuples, Zigzag,
};
use super::link_curves::{CurveTable, LinkCurves};
use super::look::{GarmentAppearance, MeshPicture};
use super::part::Part;
use super::solver::Solver;
use super::trim::{ClothTrim, TrimKind};
use super::tuck::Tuck;
use crate::fabric::loop_widths::LoopWidths;
use crate::fabric::print::{Print, PrintPattern};
use crate::fabric::stretch_curve::{ShearLock, StretchCurve, StretchCurves};
use crate::fabric::{Fabric, Weave};
use crate::mesh::{Influences, SkinWeights};
use crate::numeric::hash::of_bytes;
use crate::texture::Texture;

/// First bytes of a baked garment.
pub const MAGIC: [u8; 8] = *b"toile-gm";

/// Version of the byte form. It grows with every change of a stored field.
pub const VERSION: u32 = 1;

/// Bytes before the body: magic, version, length.
const HEAD: usize = 8 + 4 + 8;

/// Why bytes are not a garment.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum BytesError {
    /// Other bytes than a baked garment begins with.
    #[error("these bytes are not a baked garment; give what `Garment::to_bytes` wrote")]
    NotAGarment,
    /// A byte form of another version.
    #[error(
        "the garment was baked in version {found} of the byte form and this program reads version {VERSION}; bake it again"
    )]
    Version {
        /// The version found.
        found: u32,
    },
    /// The bytes end too early, or go on after the end.
    #[error("the baked garment has {found} bytes where {needed} are needed; copy the file again")]
    Length {
        /// Bytes found.
        found: u64,
        /// Bytes needed.
        needed: u64,
    },
    /// The checksum is another one.
    #[error("the baked garment is damaged (checksum {found:016x}, not {stored:016x}); copy the file again")]
    Checksum {
        /// Checksum of the bytes found.
        found: u64,
        /// The checksum stored with them.
        stored: u64,
    },
    /// A number that the field cannot have.
    #[error("the baked garment has the number {found} where {what} is expected; bake it again")]
    Value {
        /// The field's type.
        what: &'static str,
        /// The number.
        found: u64,
    },
    /// Constraints that do not hold together.
    #[error(transparent)]
    Layout(#[from] LayoutError),
}

impl Garment {
    /// Writes the garment in its byte form.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut body = Vec::with_capacity(2 * self.bytes());
        self.data.write(&mut body);
        self.layout.write(&mut body);
        let mut out = Vec::with_capacity(HEAD + body.len() + 8);
        out.extend(MAGIC);
        VERSION.write(&mut out);
        body.len().write(&mut out);
        let sum = of_bytes(&body);
        out.append(&mut body);
        sum.write(&mut out);
        out
    }

    /// Reads a garment from its byte form.
    ///
    /// # Errors
    /// [`BytesError`] for bytes of another kind or version, for damaged ones, and for constraints that [`Garment::new`]
    /// refuses.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BytesError> {
        let mut head = Reader { left: bytes };
        if head.take(MAGIC.len()).ok() != Some(&MAGIC[..]) {
            return Err(BytesError::NotAGarment);
        }
        let found = u32::read(&mut head)?;
        if found != VERSION {
            return Err(BytesError::Version { found });
        }
        let body = u64::read(&mut head)?;
        let needed = body.saturating_add(HEAD as u64 + 8);
        if bytes.len() as u64 != needed {
            return Err(BytesError::Length { found: bytes.len() as u64, needed });
        }
        let body = head.take(body as usize)?;
        let (found, stored) = (of_bytes(body), u64::read(&mut head)?);
        if found != stored {
            return Err(BytesError::Checksum { found, stored });
        }
        let mut reader = Reader { left: body };
        let data = GarmentData::read(&mut reader)?;
        let layout = Layout::read(&mut reader)?;
        let over = reader.left.len() as u64;
        if over > 0 {
            return Err(BytesError::Length { found: bytes.len() as u64, needed: bytes.len() as u64 - over });
        }
        Ok(Self::new(data, layout)?)
    }
}

/// The bytes that are still to be read.
struct Reader<'a> {
    left: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], BytesError> {
        let missing = BytesError::Length { found: self.left.len() as u64, needed: count as u64 };
        let (taken, left) = self.left.split_at_checked(count).ok_or(missing)?;
        self.left = left;
        Ok(taken)
    }
}

/// What has a byte form.
trait Stored: Sized {
    fn write(&self, out: &mut Vec<u8>);
    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError>;
}

macro_rules! numbers {
    ($($Number:ty),+) => {$(
        impl Stored for $Number {
            fn write(&self, out: &mut Vec<u8>) {
                out.extend(self.to_le_bytes());
            }

            fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
                let mut bytes = [0; size_of::<Self>()];
                bytes.copy_from_slice(from.take(size_of::<Self>())?);
                Ok(Self::from_le_bytes(bytes))
            }
        }
    )+};
}
numbers!(u8, u32, u64, f32);

macro_rules! structs {
    ($($Struct:ident $(<$(const $N:ident: usize),+>)? { $($field:ident),+ $(,)? })+) => {$(
        impl $(<$(const $N: usize),+>)? Stored for $Struct $(<$($N),+>)? {
            fn write(&self, out: &mut Vec<u8>) {
                $(self.$field.write(out);)+
            }

            fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
                Ok(Self { $($field: Stored::read(from)?),+ })
            }
        }
    )+};
}

macro_rules! enums {
    ($($Enum:ident { $($Variant:ident),+ $(,)? })+) => {$(
        impl Stored for $Enum {
            fn write(&self, out: &mut Vec<u8>) {
                (*self as u8).write(out);
            }

            fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
                let found = u8::read(from)?;
                let all = [$(Self::$Variant),+];
                let what = stringify!($Enum);
                all.into_iter().find(|v| *v as u8 == found).ok_or(BytesError::Value { what, found: found.into() })
            }
        }
    )+};
}

impl Stored for usize {
    fn write(&self, out: &mut Vec<u8>) {
        (*self as u64).write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        let found = u64::read(from)?;
        Self::try_from(found).map_err(|_| BytesError::Value { what: "a length", found })
    }
}

impl Stored for bool {
    fn write(&self, out: &mut Vec<u8>) {
        u8::from(*self).write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        match u8::read(from)? {
            0 => Ok(false),
            1 => Ok(true),
            found => Err(BytesError::Value { what: "yes or no", found: found.into() }),
        }
    }
}

impl<T: Stored> Stored for Vec<T> {
    fn write(&self, out: &mut Vec<u8>) {
        self.len().write(out);
        self.iter().for_each(|item| item.write(out));
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        let len = usize::read(from)?;
        // Every item takes a byte at least: a damaged length cannot ask for more memory than the file has.
        if len > from.left.len() {
            return Err(BytesError::Length { found: from.left.len() as u64, needed: len as u64 });
        }
        (0..len).map(|_| T::read(from)).collect()
    }
}

impl<T: Stored> Stored for Box<[T]> {
    fn write(&self, out: &mut Vec<u8>) {
        self.len().write(out);
        self.iter().for_each(|item| item.write(out));
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        Ok(Vec::read(from)?.into())
    }
}

impl<T: Stored, const N: usize> Stored for [T; N] {
    fn write(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|item| item.write(out));
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        let items: Vec<T> = (0..N).map(|_| T::read(from)).collect::<Result<_, _>>()?;
        // As many as were read: the conversion cannot fail.
        items.try_into().map_err(|_| BytesError::Value { what: "an array", found: N as u64 })
    }
}

impl<T: Stored> Stored for Option<T> {
    fn write(&self, out: &mut Vec<u8>) {
        self.is_some().write(out);
        self.iter().for_each(|value| value.write(out));
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        if bool::read(from)? { T::read(from).map(Some) } else { Ok(None) }
    }
}

impl<T: Stored> Stored for Arc<T> {
    fn write(&self, out: &mut Vec<u8>) {
        (**self).write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        T::read(from).map(Self::new)
    }
}

impl<A: Stored, B: Stored> Stored for (A, B) {
    fn write(&self, out: &mut Vec<u8>) {
        self.0.write(out);
        self.1.write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        Ok((A::read(from)?, B::read(from)?))
    }
}

impl Stored for Range<u32> {
    fn write(&self, out: &mut Vec<u8>) {
        [self.start, self.end].write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        let [start, end] = Stored::read(from)?;
        Ok(start..end)
    }
}

impl Stored for String {
    fn write(&self, out: &mut Vec<u8>) {
        self.len().write(out);
        out.extend(self.as_bytes());
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        let bytes: Vec<u8> = Stored::read(from)?;
        let len = bytes.len() as u64;
        Self::from_utf8(bytes).map_err(|_| BytesError::Value { what: "a text in UTF-8", found: len })
    }
}

impl Stored for Vec2 {
    fn write(&self, out: &mut Vec<u8>) {
        self.to_array().write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        Stored::read(from).map(Self::from_array)
    }
}

impl Stored for Vec3 {
    fn write(&self, out: &mut Vec<u8>) {
        self.to_array().write(out);
    }

    fn read(from: &mut Reader<'_>) -> Result<Self, BytesError> {
        Stored::read(from).map(Self::from_array)
    }
}

enums! {
    Direction { Warp, Weft, Bias }
    Solver { GaussSeidel, SemiImplicit, ZeroStretch }
    Part { All, Trunk, LeftArm, RightArm, Hollow, LeftLeg, RightLeg }
    TrimKind { Button, Stitches, Edge, Strip, Zip }
    Weave { Plain, Twill, Knit }
    PrintPattern { Stripes, Hoops, Gingham, Windowpane, Houndstooth, Herringbone, Dots, Flowers, Picture }
}

structs! {
    Influences<const N: usize> { bones, weights }
    Texture { width, height, texels }
    LoopWidths { bend_warp_mn, bend_weft_mn, shear_n_m }
    StretchCurve { knee_percent, knee_n_m, beyond_n_m, hysteresis_n_m }
    StretchCurves { warp, weft }
    ShearLock { degrees, beyond_n_m }
    Print { pattern, colours, repeat_mm, share, picture }
    Fabric {
        name, title, source, density_kg_m2, stretch_warp_n_m, stretch_weft_n_m, shear_n_m, bend_warp_un_m, bend_weft_un_m,
        bend_bias_un_m, friction, damping_per_s, contact_offset_mm, thickness_mm, comfortable_stretch, colour, weave,
        threads_per_cm, sheen, opacity, drape_percent, hysteresis, stretch, shear_lock, buckling, print, tile,
    }
    Tuck { into, band, particles }
    ClothTrim { panel, kind, ends, half, colour }
    MeshPicture { texture, corners }
    GarmentAppearance { cloth, edges, trims, near, picture }
    GarmentData {
        name, size, layer, tuck, fabric, source, start, inverse_mass, parts, triangles, look, fixed, fixed_weights, substeps,
        strain_edges, hoop_edges,
    }
    ConstraintRun<const K: usize> { first, len, at, serial, alike }
    Zigzag { straights, slants }
    OwnerShare { zigzags, runs, loose, loose_at, loose_serial }
    ConstraintSet { direction, crosses, shares }
    Tuples<const K: usize> { zigzags, runs, loose, sets, count, places }
    Links { tuples, rest, compliance }
    Bends<const K: usize> { tuples, coefficients }
    DiagonalShare { runs, starts }
    Diagonals { families, runs, starts, rest, compliance }
    HubGroup { points, sums, count, number, particles, coefficients }
    Hubs { particles, coefficients, groups, sets, count }
    Tethers { anchor, length }
    BundleRow { first, lanes }
    FiberBundle { solver, owner, lanes, rows, at, serial, alike }
    Fibers { bundles, rows, links, rest, compliance }
    FiberList { solver, direction, closed, lanes, rows, first, at }
    FiberLists { lists, sets, index, rest, compliance }
    CurveTable { lower, lower_slope, upper, upper_slope, friction }
    LinkCurves { diagonals, shear, weft, fibers, crossing }
    FrictionSlot { centre, kind, chords, limit, first, len }
    BendFriction { slots, particles, coefficients }
    Layout { diagonals, shear, weft, fibers, crossing, bends, skewed, hubs, link_curves, friction, tethers, spans, owner }
}

// The skin weights of a garment are influences of four bones.
const _: fn(&SkinWeights, &mut Vec<u8>) = <SkinWeights as Stored>::write;
