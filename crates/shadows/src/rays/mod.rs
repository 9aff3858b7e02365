//! Shadow rays: the ground truth that shadow maps are measured against.
//!
//! A [`RayScene`] holds [`Occluder`]s (triangles, some [alpha-tested](Cutout), some [translucent](Tint)) in a tree. [`trace_hard`] and
//! [`trace_soft`] return the visibility of a [`LightShape`] from a [`ReceiverPoint`]. [`GpuRayScene`] is the same scene for
//! `rays.wgsl`, which does the same arithmetic.
//!
//! # Ray origins
//!
//! A ray must not hit the surface that it starts from, so its origin is moved along the geometric normal by
//!
//! > offset = 2⁻²⁰ · (2 · P + R) + 2⁻¹⁷ · D
//!
//! in metres, where P is the largest absolute coordinate of the position, R the
//! [largest absolute coordinate](RayScene::max_coordinate_m) of any corner in the scene, and D the view distance. At P = R = D =
//! 1,500 m that is 16 mm, at P = D = 150 m in a scene of 150 m 1.6 mm, at P = D = 10 m in such a scene 0.24 mm.
//! With u = 2⁻²⁴, the rounding error of f32, its terms are:
//!
//! - *The position, 16 u P.* A coordinate is transformed by a matrix (4 u), interpolated (3 u) and stored, and the
//!   origin is rounded once more (1 u): 9 u P at most. A normal of unit length adds up to √3 such errors: 15.6 u P.
//! - *The triangle's test, 16 u (P + R).* A corner minus the origin, L ≤ P + R along each axis, is rounded (u L) and
//!   sheared: a product (u L) and a difference (2 u L, as the result is up to 2 L), and the rounding of z enters
//!   through the product (u L). So a corner is displaced by 5 u L along each of two axes, which lifts the plane by at
//!   most √2 · 5 u L = 7.1 u L. The distance is a mean of the corners' distances with weights that have errors of
//!   4 u each, and is rounded: 8 u L along the ray, and less across the surface. Together 15.1 u L.
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

mod channel;
mod error;
mod gpu;
mod gpu_structs;
mod light;
mod occluder;
mod ray;
mod receiver;
mod scene;
mod tree;

pub use channel::{ChannelTexture, Filter, Wrap};
pub use error::Error;
pub use gpu::GpuRayScene;
pub use gpu_structs::{NO_MATERIAL, NO_TEXTURE, RayMaterial, RayNode, RayTexture, RayTriangle, TINT};
pub use light::{GroundTruth, LIGHT_DISTANCE_FRACTION, LightShape, trace_hard, trace_soft};
pub use occluder::{Cutout, Occluder, Surface, Tint};
pub use ray::{Ray, TriangleHit};
pub use receiver::{OFFSET_PER_COORDINATE, OFFSET_PER_VIEW_DISTANCE, ReceiverPoint};
pub use scene::RayScene;
pub use tree::MAX_DEPTH;
