//! The colours of the office, with the reflectivities of real materials, and the luminances of its lights.

use super::super::shapes::{Builder, paint, panel};
use crate::math::Rgb;
use crate::scene::Material;

/// Numbers of the materials.
pub struct Palette {
    pub wall: u32,
    pub ceiling: u32,
    pub planks: [u32; 4],
    pub white: u32,
    pub wood: u32,
    pub dark_wood: u32,
    pub steel: u32,
    pub black: u32,
    pub brass: u32,
    pub paper: u32,
    pub clay: u32,
    pub soil: u32,
    pub leaf: u32,
    pub linen: u32,
    /// Fabrics of the chairs, paint of the shades, glaze of the mugs.
    pub accents: [u32; 4],
    pub books: [u32; 8],
    pub sky: u32,
    pub ceiling_light: u32,
    pub bulb: u32,
    pub screen: u32,
}

/// Cool light of an overcast sky, and warm white of about 3,000 K, in linear Rec. 709.
const DAYLIGHT: Rgb = Rgb::new(0.86, 1.0, 1.2);
const NEUTRAL: Rgb = Rgb::new(1.1, 1.0, 0.82);
const WARM: Rgb = Rgb::new(1.4, 0.95, 0.5);

impl Palette {
    pub fn new(builder: &mut Builder) -> Palette {
        let two_sided = |material| Material { two_sided: true, ..material };
        let mut add = |material| builder.material(material);
        Palette {
            wall: add(paint("wall", [236, 231, 222])),
            ceiling: add(paint("ceiling", [240, 239, 236])),
            planks: [[186, 142, 97], [176, 131, 87], [195, 152, 107], [168, 124, 83]].map(|c| add(paint("oak", c))),
            white: add(paint("white", [238, 237, 233])),
            wood: add(paint("ash", [214, 178, 132])),
            dark_wood: add(paint("walnut", [134, 91, 61])),
            steel: add(paint("steel", [150, 152, 155])),
            black: add(paint("black", [45, 46, 49])),
            brass: add(paint("brass", [193, 156, 92])),
            paper: add(paint("paper", [240, 238, 230])),
            clay: add(paint("clay", [196, 112, 78])),
            soil: add(paint("soil", [72, 55, 44])),
            leaf: add(two_sided(paint("leaf", [84, 128, 66]))),
            linen: add(two_sided(paint("linen", [229, 221, 205]))),
            accents: [[222, 165, 60], [60, 128, 130], [206, 98, 78], [96, 112, 138]].map(|c| add(paint("accent", c))),
            books: [
                [178, 58, 52],
                [214, 150, 62],
                [236, 222, 190],
                [70, 120, 112],
                [52, 84, 132],
                [120, 150, 178],
                [146, 82, 96],
                [88, 92, 84],
            ]
            .map(|c| add(paint("book", c))),
            sky: add(panel("sky", 1200.0, DAYLIGHT)),
            ceiling_light: add(panel("ceiling light", 2000.0, NEUTRAL)),
            bulb: add(panel("bulb", 12_000.0, WARM)),
            screen: add(panel("screen", 120.0, DAYLIGHT)),
        }
    }
}
