//! The garments of the made-up shop.

/// A colour: its names in English and German, sRGB.
pub type ShopColour = (&'static str, &'static str, [f32; 3]);

/// A garment of the shop.
pub struct ShopGarment {
    /// Its package, without the ending.
    pub file: &'static str,
    /// Article number.
    pub article: &'static str,
    /// The draft that it is made from.
    pub draft: &'static str,
    /// The fabric, one that is built in.
    pub fabric: &'static str,
    /// Its names in English and German.
    pub names: [&'static str; 2],
    /// Its price.
    pub price: &'static str,
    /// Its colours: the ground of its print.
    pub colours: &'static [ShopColour],
}

const CHALK: ShopColour = ("Chalk", "Kreide", [0.94, 0.93, 0.89]);
const SHELL: ShopColour = ("Shell", "Muschel", [0.93, 0.80, 0.74]);
const MIST: ShopColour = ("Mist", "Nebel", [0.78, 0.85, 0.88]);
const REED: ShopColour = ("Reed", "Schilf", [0.62, 0.66, 0.48]);
const TIDE: ShopColour = ("Tide", "Flut", [0.16, 0.27, 0.38]);
const PEBBLE: ShopColour = ("Pebble", "Kiesel", [0.58, 0.57, 0.54]);

/// All six, in the order of the catalogue.
pub const GARMENTS: [ShopGarment; 6] = [
    ShopGarment {
        file: "pier-dress",
        article: "HM-301",
        draft: "shift-dress",
        fabric: "linen-stripe",
        names: ["Pier dress", "Seebrückenkleid"],
        price: "119.00 EUR",
        colours: &[CHALK, SHELL, MIST],
    },
    ShopGarment {
        file: "meadow-skirt",
        article: "HM-204",
        draft: "circle-skirt",
        fabric: "lawn-flowers",
        names: ["Meadow skirt", "Wiesenrock"],
        price: "69.00 EUR",
        colours: &[CHALK, MIST, REED],
    },
    ShopGarment {
        file: "promenade-trousers",
        article: "HM-210",
        draft: "slim-trousers",
        fabric: "linen-twill",
        names: ["Promenade trousers", "Promenadenhose"],
        price: "89.00 EUR",
        colours: &[TIDE, PEBBLE, REED],
    },
    ShopGarment {
        file: "picnic-shirt",
        article: "HM-112",
        draft: "shirt",
        fabric: "lawn-gingham",
        names: ["Picnic shirt", "Picknickhemd"],
        price: "64.50 EUR",
        colours: &[CHALK, SHELL],
    },
    ShopGarment {
        file: "harbour-jumper",
        article: "HM-118",
        draft: "jumper",
        fabric: "jersey-breton",
        names: ["Harbour jumper", "Hafenpullover"],
        price: "74.00 EUR",
        colours: &[CHALK, MIST],
    },
    ShopGarment {
        file: "station-blazer",
        article: "HM-407",
        draft: "blazer",
        fabric: "wool-houndstooth",
        names: ["Station blazer", "Bahnhofsblazer"],
        price: "189.00 EUR",
        colours: &[CHALK, PEBBLE],
    },
];

impl ShopGarment {
    /// What its package says of it.
    pub fn manifest(&self) -> String {
        let Self { article, draft, fabric, names: [en, de], price, .. } = self;
        let colour =
            |(en, de, srgb): &ShopColour| format!("{{ name = {{ en = {en:?}, de = {de:?} }}, srgb = {srgb:?} }}");
        let colours: Vec<String> = self.colours.iter().map(colour).collect();
        format!(
            "article = {article:?}\ngarment = {draft:?}\nname = {{ en = {en:?}, de = {de:?} }}\nprice = {price:?}\n\
             fabric = {fabric:?}\nphotographs = [\"front.png\"]\ncolours = [{}]\n",
            colours.join(", ")
        )
    }
}
