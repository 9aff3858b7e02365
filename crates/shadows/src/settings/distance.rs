//! The measure of the shadow distance.

use crate::declare_settings;

declare_settings! {
    /// How the distance of a point from the camera is measured, for the end of shadows.
    #[derive(Copy, Eq, Hash)]
    #[default(ViewDepth)]
    pub enum DistanceMeasure {
        /// Along the view direction: shadows end at a plane, which turns with the camera.
        ViewDepth;
        /// In all directions: shadows end at a sphere around the camera, so turning it changes none.
        Radius;
    }
}
