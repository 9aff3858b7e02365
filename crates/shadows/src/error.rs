//! Errors of planning and of techniques.

/// Errors of shadows.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value of [`ShadowSettings`](crate::ShadowSettings) is out of range.
    #[error("shadow setting `{field}` is {value}; allowed: {allowed}")]
    Setting {
        /// The field's path, such as `cascades.map_size_px`.
        field: &'static str,
        /// The value.
        value: String,
        /// The allowed values.
        allowed: &'static str,
    },
    /// [`ShadowSettings::lights`](crate::ShadowSettings::lights) refers to a light that does not exist.
    #[error(
        "unknown light {light} in shadow setting `lights.light`; the scene has {count} lights, numbered from 0"
    )]
    UnknownLight {
        /// Index of the entry of `lights`.
        entry: usize,
        /// Its number, or its name in quotes.
        light: String,
        /// Number of lights in the scene.
        count: usize,
    },
    /// [`ShadowSettings::lights`](crate::ShadowSettings::lights) has two entries for one light.
    #[error("duplicate entry for light {light} in shadow setting `lights`; allowed: one for each light")]
    DuplicateLight {
        /// Index of the second entry of `lights`.
        entry: usize,
        /// Its number.
        light: usize,
    },
    /// The camera is invalid.
    #[error(transparent)]
    Camera(#[from] shadowgraph_scene::CameraError),
    /// A technique that reads surface buffers got none.
    #[error("technique `{technique}` reads surface buffers: draw them first and pass them to `add_shadows`")]
    MissingSurfaceBuffers {
        /// The technique's name.
        technique: String,
    },
    /// A technique is inconsistent with its declarations, or has invalid settings.
    #[error("technique `{technique}`: {reason}")]
    Technique {
        /// Its name.
        technique: String,
        /// What is wrong.
        reason: String,
    },
    /// The settings of a technique cannot be parsed.
    #[error(
        "technique `{technique}`: its settings: {} (line {}, column {} of them)",
        reason.code, reason.span.start.line, reason.span.start.col
    )]
    MalformedSettings {
        /// Its name.
        technique: String,
        /// What is wrong, and the position in the text of its settings.
        reason: Box<ron::error::SpannedError>,
    },
    /// A value of a technique's settings is out of range.
    #[error("technique `{technique}`: shadow setting `{field}` is {value}; allowed: {allowed}")]
    TechniqueSetting {
        /// Its name.
        technique: String,
        /// The field's path in its settings.
        field: &'static str,
        /// The value.
        value: String,
        /// The allowed values.
        allowed: &'static str,
    },
    /// The name of a technique is unknown.
    #[error("unknown technique `{name}`{hint}")]
    UnknownTechnique {
        /// The unknown name.
        name: String,
        /// The known names, and a similar one if there is one.
        hint: String,
    },
    /// A shader does not compose.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
    /// The scene's triangles cannot be traced.
    #[error(transparent)]
    Rays(#[from] crate::rays::Error),
}
