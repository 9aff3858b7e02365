//! Errors of planning and of techniques.

/// Errors of shadows.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value of [`ShadowSettings`](crate::ShadowSettings) is out of range.
    #[error("invalid value: `{field}` is {value}; allowed: {allowed}")]
    Setting {
        /// The field's path, such as `cascades.map_size_px` or `techniques.pcss.filter_taps`.
        field: String,
        /// The value.
        value: String,
        /// The allowed values, with their unit.
        allowed: String,
    },
    /// [`ShadowSettings::lights`](crate::ShadowSettings::lights) refers to a light that does not exist.
    #[error(
        "unknown light {light} in shadow setting `lights.light`; lights in the scene: {count}, numbered from 0"
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
    /// A technique that traces rays got casters without triangles.
    #[error("technique `{technique}` traces the casters' triangles: implement `ShadowCasters::rays`")]
    MissingRays {
        /// The technique's name.
        technique: String,
    },
    /// A technique that draws views that the GPU writes got casters that cannot be drawn in them.
    #[error(
        "technique `{technique}` draws casters in views that the GPU writes: implement `ShadowCasters::layered`"
    )]
    MissingLayers {
        /// The technique's name.
        technique: String,
    },
    /// A technique is inconsistent with its declarations, or has invalid settings.
    #[error("technique `{technique}`: {reason}")]
    Technique {
        /// Its name.
        technique: String,
        /// The problem.
        reason: String,
    },
    /// The settings of a technique cannot be parsed.
    #[error(
        "settings of technique `{technique}`: {} (line {}, column {} of them)",
        reason.code, reason.span.start.line, reason.span.start.col
    )]
    MalformedSettings {
        /// Its name.
        technique: String,
        /// The problem, and the position in the text of its settings.
        reason: Box<ron::error::SpannedError>,
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

impl Error {
    /// Returns the error with the name of the struct that the field is in before its path.
    #[must_use]
    pub fn inside(self, parent: &str) -> Self {
        match self {
            Self::Setting { field, value, allowed } => {
                let field = match (&*field, parent) {
                    (_, "") => field,
                    ("", _) => parent.to_owned(),
                    _ => format!("{parent}.{field}"),
                };
                Self::Setting { field, value, allowed }
            }
            other => other,
        }
    }

    /// Returns the error with other words for what is allowed.
    pub(crate) fn allowing(self, allowed: String) -> Self {
        match self {
            Self::Setting { field, value, .. } => Self::Setting { field, value, allowed },
            other => other,
        }
    }
}
