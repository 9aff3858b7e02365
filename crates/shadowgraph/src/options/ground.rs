//! The ground under a scene.

use super::color;
use super::error::OptionError;
use glam::{DAffine3, DVec3, Vec3};
use shadowgraph_scene::{Aabb, GroundPlane, Instance, Material, Mesh, Scene, ShadowCasting, Vertex};
use std::str::FromStr;

const OPTION: &str = "ground";

/// The side of a plane in radii of the scene.
const SIDE_RADII: f64 = 40.0;

/// The plane under a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GroundChoice {
    /// The [missing ground](Scene::missing_ground) of the scene, which is part of the background and only in colour images.
    #[default]
    Auto,
    /// None.
    None,
    /// A square of this colour, linear RGB, each 0 to 1, 40 radii of the scene wide. It is an object of the scene, so all AOVs have it, and casts no
    /// shadow.
    Color(Vec3),
}

/// The plane for a scene, from [`GroundChoice::place`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlacedGround {
    /// None.
    None,
    /// A part of the background.
    Plane(GroundPlane),
    /// An object under these bounds.
    Object {
        /// The bounds of the scene, metres.
        bounds: Aabb,
        /// Linear RGB, each 0 to 1.
        color: Vec3,
    },
}

impl GroundChoice {
    /// Places the ground under a scene; with [`Auto`](Self::Auto) only for images that show it: images in colour by a pipeline
    /// [with a sky](crate::Pipeline::has_sky). Place it before an animation moves the scene, so that it does not depend on the time.
    ///
    /// ```
    /// use shadowgraph::options::GroundChoice;
    /// use shadowgraph::scene::{Instance, Material, Mesh, Scene};
    /// let mut scene = Scene::default();
    /// let mesh = scene.insert_mesh(Mesh::cuboid(glam::DVec3::ZERO, glam::DVec3::ONE));
    /// let material = scene.insert_material(Material::default())?;
    /// scene.insert_instance(Instance::new(mesh, material, glam::DAffine3::IDENTITY))?;
    /// GroundChoice::Auto.place(&scene, true).add_to(&mut scene);
    /// assert_eq!(scene.ground.map(|ground| ground.height_world), Some(0.0));
    /// GroundChoice::Color(glam::Vec3::ONE).place(&scene, true).add_to(&mut scene);
    /// assert_eq!((scene.ground, scene.instances().len()), (None, 2));
    /// # Ok::<(), shadowgraph::scene::EditError>(())
    /// ```
    #[must_use]
    pub fn place(&self, scene: &Scene, is_shown: bool) -> PlacedGround {
        let bounds = scene.bounds();
        match *self {
            Self::Color(color) if !bounds.is_empty() => PlacedGround::Object { bounds, color },
            Self::Auto if is_shown => scene.missing_ground().map_or(PlacedGround::None, PlacedGround::Plane),
            _ => PlacedGround::None,
        }
    }
}

impl PlacedGround {
    /// Adds the ground to the scene, in place of its former [`ground`](Scene::ground). Returns whether an object was added.
    pub fn add_to(&self, scene: &mut Scene) -> bool {
        scene.ground = match self {
            Self::Plane(plane) => Some(*plane),
            Self::None | Self::Object { .. } => None,
        };
        match self {
            Self::Object { bounds, color } => insert_plane(scene, bounds, *color),
            Self::None | Self::Plane(_) => false,
        }
    }
}

/// Adds a plane under the bounds.
fn insert_plane(scene: &mut Scene, bounds: &Aabb, color: Vec3) -> bool {
    let half = (bounds.radius().max(1e-3) * SIDE_RADII * 0.5) as f32;
    let corner = |x: f32, z: f32| Vertex {
        position: [x * half, 0.0, z * half],
        normal: [0.0, 1.0, 0.0],
        ..Vertex::default()
    };
    let corners = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let mesh = scene.insert_mesh(Mesh::new("ground", corners, vec![0, 1, 2, 0, 2, 3]));
    let base_color = color.extend(1.0);
    let Ok(material) = scene.insert_material(Material {
        name: "ground".into(),
        base_color,
        metallic: 0.0,
        roughness: 1.0,
        ..Material::default()
    }) else {
        return false;
    };
    let below = DVec3 { y: bounds.min.y, ..bounds.center() };
    let plane = Instance::new(mesh, material, DAffine3::from_translation(below)).with_name("ground");
    scene.insert_instance(Instance { casts: ShadowCasting::Off, ..plane }).is_ok()
}

impl FromStr for GroundChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text {
            "auto" => Ok(Self::Auto),
            "none" => Ok(Self::None),
            _ => color::parse(OPTION, text, "auto, none").map(Self::Color),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_colour_is_linear_or_srgb() {
        assert_eq!("#ff0000".parse(), Ok(GroundChoice::Color(Vec3::X)));
        assert_eq!("0,0.5,1".parse(), Ok(GroundChoice::Color(Vec3::new(0.0, 0.5, 1.0))));
        assert_eq!(
            "grey".parse::<GroundChoice>().unwrap_err().to_string(),
            "ground: invalid value `grey`; expected auto, none, #RRGGBB, or R,G,B (linear, each 0 to 1)"
        );
    }

    #[test]
    fn an_empty_scene_gets_no_ground() {
        let mut scene = Scene::default();
        for choice in [GroundChoice::Auto, GroundChoice::Color(Vec3::ONE)] {
            assert!(!choice.place(&scene, true).add_to(&mut scene));
        }
        assert_eq!((scene.ground, scene.instances().len()), (None, 0));
    }
}
