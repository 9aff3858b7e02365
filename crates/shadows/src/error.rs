//! What can go wrong before a device is involved.

/// Why shadows could not be planned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value of [`ShadowSettings`](crate::ShadowSettings) is not allowed.
    #[error("shadow setting `{field}` is {value}; allowed: {allowed}")]
    Setting {
        /// The field's path, such as `cascades.map_size_px`.
        field: &'static str,
        /// The value it has.
        value: String,
        /// The values it can have.
        allowed: &'static str,
    },
    /// [`ShadowSettings::lights`](crate::ShadowSettings::lights) names a light that the scene does not have.
    #[error(
        "shadow setting `lights.light` is {light}; the scene has no light of that name or number, but {count}, numbered from 0"
    )]
    UnknownLight {
        /// Which entry of `lights` names it, from 0.
        entry: usize,
        /// Its number, or its name in quotes.
        light: String,
        /// How many lights there are.
        count: usize,
    },
    /// [`ShadowSettings::lights`](crate::ShadowSettings::lights) says two things of one light.
    #[error("shadow setting `lights` has two entries for light {light}; allowed: one for each light")]
    DuplicateLight {
        /// The second entry of `lights`, from 0.
        entry: usize,
        /// Its number.
        light: usize,
    },
    /// The camera sees nothing.
    #[error(transparent)]
    Camera(#[from] shadowgraph_scene::CameraError),
    /// A technique that reads the picture's surfaces was not given them.
    #[error(
        "the technique `{technique}` reads the surfaces of the picture: draw them first and pass them to its `add_to`"
    )]
    MissingSurfaceBuffers {
        /// The technique's name.
        technique: String,
    },
    /// A technique is not what it says, or has settings that it cannot have.
    #[error("technique `{technique}`: {reason}")]
    Technique {
        /// Its name.
        technique: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The settings of a technique are not of the form that it reads.
    #[error(
        "technique `{technique}`: its settings: {} (line {}, column {} of them)",
        reason.code, reason.span.start.line, reason.span.start.col
    )]
    MalformedSettings {
        /// Its name.
        technique: String,
        /// What is wrong, and where in the text of its settings alone.
        reason: Box<ron::error::SpannedError>,
    },
    /// A value of a technique's own settings is not allowed.
    #[error("technique `{technique}`: shadow setting `{field}` is {value}; allowed: {allowed}")]
    TechniqueSetting {
        /// Its name.
        technique: String,
        /// The field's path in its settings.
        field: &'static str,
        /// The value it has.
        value: String,
        /// The values it can have.
        allowed: &'static str,
    },
    /// There is no technique of this name.
    #[error("unknown technique `{name}`{hint}")]
    UnknownTechnique {
        /// What was asked for.
        name: String,
        /// A name that is like it, or all.
        hint: String,
    },
    /// A shader does not compose.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
    /// The triangles cannot be traced.
    #[error(transparent)]
    Rays(#[from] crate::rays::Error),
}
