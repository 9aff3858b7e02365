//! Culling of casters without a change to any pixel.
//!
//! - [`ReceiverHull`] is the part of the view in which shadows are visible. [`ReceiverHull::swept_towards`] and
//!   [`ReceiverHull::hull_with`] are the volumes outside which a caster cannot darken anything in it.
//! - [`RedundantCasters`] finds the casters that a cascade does not need: those that can darken only receivers that read a
//!   finer cascade, or no visible receiver.
//!
//! Both are conservative: a culled caster darkens no visible point, while some casters that could be culled are kept.

mod light_space_view;
mod receivers;
mod redundant;
mod supporting_planes;
mod volumes;

pub use light_space_view::LightSpaceView;
pub use receivers::ReceiverHull;
pub use redundant::{CoveredByFinerCascade, RedundantCasters};

#[cfg(test)]
mod random;
