//! Shadow rays: the ground truth that shadow maps are measured against.
//!
//! A [`RayScene`] holds meshes of triangles, some [alpha-tested](Cutout), some [translucent](Tint), and their [`Instance`]s. [`trace_hard`]
//! and [`trace_soft`] return the visibility of a [`LightShape`] from a [`ReceiverPoint`]. [`GpuRayScene`] is the same scene for `rays.wgsl`,
//! which does the same arithmetic.
//!
//! # Two levels
//!
//! Each mesh has a tree over its triangles, in its own space, which its instances share; a tree over the boxes of the instances in the world
//! leads to them (Wald, Benthin and Slusallek, "Distributed Interactive Ray Tracing of Dynamic Scenes", 2003). So a moved instance changes
//! its transform and the boxes above it, and a posed mesh its own tree. Both are refitted, and rebuilt when that has made them too slow.
//!
//! ```
//! use glam::{DAffine3, DVec3, Vec3};
//! use shadowgraph_shadows::rays::{Instance, Ray, RayScene};
//! let mut scene = RayScene::default();
//! let mesh = scene.insert_mesh(&[[Vec3::ZERO, Vec3::X, Vec3::Z]])?;
//! let up = |y: f64| DAffine3::from_translation(DVec3::Y * y);
//! let place = |y| Instance { mesh, surfaces: None, world_from_mesh: up(y) };
//! let (low, _high) = (scene.insert_instance(place(1.0))?, scene.insert_instance(place(5.0))?);
//! let ray = Ray::new(Vec3::new(0.2, 0.0, 0.2), Vec3::Y, 0.0, f32::INFINITY);
//! assert_eq!(scene.nearest_distance(&ray), Some(1.0));
//! scene.set_transform(low, up(9.0))?;
//! assert_eq!(scene.nearest_distance(&ray), Some(5.0));
//! # Ok::<(), shadowgraph_shadows::rays::Error>(())
//! ```
//!
//! Boxes are tested in the space of the mesh, triangles in the world: their corners are transformed as the rasterizer transforms them. So
//! distances and the origins of rays need no conversion, edges are watertight under any transform, and a transform without an inverse (a mesh
//! flattened to a plane) is allowed; such a mesh only has no use of its boxes.
//!
//! # Ray origins
//!
//! A ray must not hit the surface that it starts from, so its origin is moved along the geometric normal by
//!
//! > offset = 2⁻²⁰ · (2 · P + 1.5 · R) + 2⁻¹⁷ · D
//!
//! in metres, where P is the largest absolute coordinate of the position, R the
//! [largest coordinate](RayScene::max_coordinate_m) of the scene, and D the view distance. At P = R = D =
//! 1,500 m that is 16 mm, at P = D = 150 m in a scene of 150 m 1.6 mm, at P = D = 10 m in such a scene 0.31 mm.
//! With u = 2⁻²⁴, the rounding error of f32, its terms are:
//!
//! - *The position, 16 u P.* A coordinate is transformed by a matrix (4 u), interpolated (3 u) and stored, and the
//!   origin is rounded once more (1 u): 9 u P at most. A normal of unit length adds up to √3 such errors: 15.6 u P.
//! - *The triangle's test, 16 u P + 24 u R.* A corner is the sum of an offset and three products, R at most together, so it is displaced by
//!   4 u R along each of three axes, which lifts the triangle's plane by at most √3 · 4 u R = 6.9 u R. The corner
//!   minus the origin, L ≤ P + R along each axis, is rounded (u L) and
//!   sheared: a product (u L) and a difference (2 u L, as the result is up to 2 L), and the rounding of z enters
//!   through the product (u L). So a corner is displaced by 5 u L along each of two axes, which lifts the plane by at
//!   most √2 · 5 u L = 7.1 u L. The distance is a mean of the corners' distances with weights that have errors of
//!   4 u each, and is rounded: 8 u L along the ray, and less across the surface. Together 15.1 u L + 6.9 u R.
//! - *Perspective, 128 u D.* A rasterizer that interpolates p/w and 1/w over the screen makes errors of the order of
//!   the largest p/w on the screen, not of that at the pixel: u · P · D / N, where N is the view depth at which the
//!   surface's plane comes nearest to the viewer on the screen. The term covers N ≥ P / 128: ground 1.2 m in front
//!   of the viewer for points 150 m away. Rasterizers that interpolate from a corner make no such error.
//!
//! Measured on 200,000 random triangles each of widths from 1 to 1/10,000 of their length, with coordinates up to
//! 1,500 m and a position's error of 9 u P: half of the first two terms was always enough.
//!
//! The price: along a ray, everything nearer than the offset divided by N·L is missed. The corners that the
//! rasterizer uses and those passed here are assumed to be the same to within the first term.
//!
//! The light is always above the side that faces the viewer; otherwise N·L ≤ 0 and the surface is dark.
//!
//! # Margins of boxes
//!
//! A ray that the test of a triangle would accept must enter all boxes around the triangle, so they are widened by 64 u · S · (P + R), where P
//! is the largest coordinate of the ray's origin and S, for each axis of the space of the boxes, the sum of the absolute values of that
//! row of the matrix from the world (1 in the world). In the same unit u · S · (P + R) the errors are: the origin's transform 6, the
//! direction's over the length of the ray 7, the corners 4, the triangle's test 7, the box's test 16 with WGSL's division.

mod channel;
mod error;
mod gpu;
mod gpu_structs;
mod instance;
mod instance_tree;
mod keys;
mod light;
mod mesh;
mod pool;
mod ray;
mod receiver;
mod scene;
mod surface;
mod trace;
mod tree;

pub use channel::{ChannelTexture, Filter, Wrap};
pub use error::Error;
pub use gpu::GpuRayScene;
pub use gpu_structs::{
    RAY_INSTANCE, RAY_NONE, RayInstance, RayNode, RaySurface, RayTexture, RayTriangle, TINT,
};
pub use instance::Instance;
pub use keys::{RayInstanceKey, RayMeshKey, RaySurfacesKey, RayTextureKey};
pub use light::{GroundTruth, LIGHT_DISTANCE_FRACTION, LightShape, trace_hard, trace_soft};
pub use ray::{Ray, TriangleHit};
pub use receiver::{OFFSET_PER_COORDINATE, OFFSET_PER_VIEW_DISTANCE, ReceiverPoint};
pub use scene::RayScene;
pub(crate) use scene::SurfaceKinds;
pub use surface::{Cutout, Surface, Tint};
pub use trace::NearestHit;
pub use tree::{MESH_DEPTH, TOP_DEPTH};
