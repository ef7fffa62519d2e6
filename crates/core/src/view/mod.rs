//! What people look at: the light interpolated over the surface, and a picture of it.
//!
//! ```text
//! Solution --vertex_field--> VertexField --picture--> Picture (cd/m², and tone-mapped for a screen)
//!    crease, contacts: which element corners are one vertex    camera_rays, default_view: where from
//!    neighbours, smooth: noise taken out (of tables, too)      surface_light, tone: what is seen there
//!    cover, vertex_weights, pycnophylactic, seams: what the value of a vertex is
//! ```

pub mod camera_rays;
mod contacts;
pub(crate) mod cover;
pub(crate) mod crease;
mod default_view;
mod grid;
pub(crate) mod neighbours;
pub mod picture;
pub(crate) mod plastic;
mod pycnophylactic;
mod seams;
pub mod smooth;
pub mod surface_light;
pub mod tone;
pub mod vertex_field;
mod vertex_weights;
pub(crate) mod vertices;

pub use default_view::camera as default_camera;
pub use picture::{ElementPicture, Picture, ViewOptions, elements, exposure, render, render_field};
pub use seams::EdgePoints;
pub use smooth::smooth;
pub use tone::Exposure;
pub use vertex_field::VertexField;

/// A side with less than this share of the other side's light is the inside of something: nobody sees it there, and what is made to be looked
/// at leaves it out.
pub const INSIDE: f32 = 0.01;

#[cfg(test)]
pub(crate) mod tests {
    use crate::Solution;
    use crate::math::Rgb;

    /// A solution with the given irradiance [lux] per element and no known error.
    pub fn solution(irradiance: Vec<Rgb>) -> Solution {
        let std_error = vec![Rgb::grey(f32::NAN); irradiance.len()];
        Solution { irradiance, std_error, ..Solution::default() }
    }
}
