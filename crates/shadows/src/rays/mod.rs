//! Shadow rays: the truth that shadow maps are measured against.
//!
//! A [`RayScene`] holds [`Occluder`]s (triangles, some [cut](Cut), some [translucent](Tint)) in a tree. [`trace_hard`] and
//! [`trace_soft`] tell how much of a [`LightShape`] a [`ReceiverPoint`] sees. [`GpuRayScene`] is the same scene for
//! `rays.wgsl`, which does the same arithmetic.
//!
//! # Where a ray starts
//!
//! A ray must not meet the surface that it starts from, so its origin is moved along the geometric normal by
//!
//! > offset = 2⁻²⁰ · (2 · P + R) + 2⁻¹⁷ · D
//!
//! in metres, where P is the largest coordinate of the position (either sign), R the scene's
//! [reach](RayScene::reach_m), its largest coordinate of any corner, and D the view distance. At P = R = D =
//! 1,500 m that is 16 mm, at P = D = 150 m in a scene of 150 m 1.6 mm, at P = D = 10 m in such a scene 0.24 mm.
//! With u = 2⁻²⁴, the rounding error of f32, its parts are:
//!
//! - *The position, 16 u P.* A coordinate goes through a matrix (4 u), an interpolation (3 u), and a store, and the
//!   origin is rounded once more (1 u): 9 u P at most. A normal of unit length adds up to √3 such errors: 15.6 u P.
//! - *The triangle's test, 16 u (P + R).* A corner minus the origin, L ≤ P + R along each axis, is rounded (u L) and
//!   sheared: a product (u L) and a difference (2 u L, as the result is up to 2 L), and the rounding of z comes in
//!   through the product (u L). So a corner is displaced by 5 u L along each of two axes, which lifts the plane by at
//!   most √2 · 5 u L = 7.1 u L. The distance is a mean of the corners' distances with weights that are wrong by
//!   4 u each, and is rounded: 8 u L along the ray, and less across the surface. Together 15.1 u L.
//! - *Perspective, 128 u D.* A rasterizer that interpolates p/w and 1/w over the screen makes errors in the size of
//!   the largest p/w on the screen, not of that at the pixel: u · P · D / N, where N is the view depth at which the
//!   surface's plane comes nearest to the viewer on the screen. The part covers N ≥ P / 128: ground 1.2 m in front
//!   of the viewer for points 150 m away. Rasterizers that interpolate from a corner make no such error.
//!
//! Measured on 200,000 random triangles each of widths from 1 to 1/10,000 of their length, with coordinates up to
//! 1,500 m and a position's error of 9 u P: half of the first two parts was always enough.
//!
//! Along a ray, everything nearer than the offset divided by N·L is missed: the price of it. The corners that the
//! rasterizer has and those given here are assumed to be the same to within the first part.
//!
//! The light is always above the side that the viewer sees, or else the surface is dark by itself: N·L ≤ 0.

mod channel;
mod error;
mod gpu;
mod light;
mod occluder;
mod ray;
mod receiver;
mod records;
mod scene;
mod tree;

pub use channel::{ChannelTexture, Filter, Wrap};
pub use error::Error;
pub use gpu::GpuRayScene;
pub use light::{GroundTruth, LIGHT_DISTANCE_FRACTION, LightShape, trace_hard, trace_soft};
pub use occluder::{Cut, Occluder, Surface, Tint};
pub use ray::{Ray, TriangleHit};
pub use receiver::{OFFSET_PER_COORDINATE, OFFSET_PER_VIEW_DISTANCE, ReceiverPoint};
pub use records::{NO_CUT, NO_TEXTURE, RayCut, RayNode, RayTexture, RayTriangle, TINT};
pub use scene::RayScene;
pub use tree::MAX_DEPTH;
