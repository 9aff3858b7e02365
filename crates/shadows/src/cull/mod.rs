//! Which casters can be left out of a shadow map without a change to any pixel.
//!
//! - [`ReceiverHull`] is the part of the view in which shadows are seen. [`ReceiverHull::swept_towards`] and
//!   [`ReceiverHull::hull_with`] are the spaces outside which a caster cannot darken anything in it.
//! - [`RedundantCasters`] tells which casters a cascade does without: those that can darken only what reads a finer
//!   cascade, or nothing that is seen.
//!
//! Both err on the side of keeping: a caster that is dropped touches no visible point, while some that could
//! have been dropped stay.

mod receivers;
mod served;
mod supports;
mod view_in_light;
mod volumes;

pub use receivers::ReceiverHull;
pub use served::{CoveredByFinerCascade, RedundantCasters};
pub use view_in_light::LightSpaceView;

#[cfg(test)]
mod testing;
