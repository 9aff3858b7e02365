//! Structs that Rust writes and WGSL reads.

use shadowgraph_shaders::{Error, layout, naga};

use crate::settings::{DescribeSettings, SettingType};

/// A scalar of a WGSL struct: its name and its type, such as `f32`.
pub type GpuField = (&'static str, &'static str);

/// The fields of a struct in WGSL, all of them scalars of four bytes, which have no gaps between them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpuStruct {
    /// The struct's name in WGSL.
    pub name: &'static str,
    /// The fields in their order.
    pub fields: Vec<GpuField>,
}

impl GpuStruct {
    /// Describes the struct of this name that `T` writes.
    #[must_use]
    pub fn new<T: GpuData>(name: &'static str) -> Self {
        let mut fields = Vec::new();
        T::describe("", &mut fields);
        Self { name, fields }
    }

    /// Compares the fields with those of the struct in the module.
    pub(crate) fn check(&self, module: &naga::Module) -> Result<(), Error> {
        let offsets =
            self.fields.iter().enumerate().map(|(index, (field, _))| (*field, SCALAR_BYTES * index));
        layout::check(module, self.name, SCALAR_BYTES * self.fields.len(), &offsets.collect::<Vec<_>>())?;
        layout::check_types(module, self.name, &self.fields)
    }
}

/// The size of every scalar.
const SCALAR_BYTES: usize = 4;

/// Values that a shader reads: a scalar, the scalars of [declared settings](crate::declare_settings), or a struct of these
/// declared by [`gpu_struct!`](crate::gpu_struct).
///
/// Settings are numbers and toggles (a `bool` is a `u32`, 0 or 1) in the order of their declaration; enums, lists and optional
/// values are left out.
pub trait GpuData {
    /// Appends the scalars' fields. `name` is that of the value itself, if it is a scalar.
    fn describe(name: &'static str, fields: &mut Vec<GpuField>);

    /// Appends the scalars.
    fn write(&self, bytes: &mut Vec<u8>);

    /// Returns the contents of a buffer that holds the struct.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.write(&mut bytes);
        bytes
    }
}

impl GpuData for f32 {
    fn describe(name: &'static str, fields: &mut Vec<GpuField>) {
        fields.push((name, "f32"));
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_ne_bytes());
    }
}

impl GpuData for u32 {
    fn describe(name: &'static str, fields: &mut Vec<GpuField>) {
        fields.push((name, "u32"));
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_ne_bytes());
    }
}

impl<S: DescribeSettings> GpuData for S {
    fn describe(_name: &'static str, fields: &mut Vec<GpuField>) {
        let scalars = S::settings().iter().filter_map(|setting| match setting.ty {
            SettingType::Toggle(_) | SettingType::Integer(..) | SettingType::PowerOfTwo(..) => {
                Some((setting.name, "u32"))
            }
            SettingType::Number(..) => Some((setting.name, "f32")),
            _ => None,
        });
        fields.extend(scalars);
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        self.write_scalars(bytes);
    }
}

/// Declares a struct that a shader reads. Its fields are `f32`, `u32`, settings, or other such structs; those of the latter two
/// stand in its place in WGSL.
///
/// ```
/// use shadowgraph_shadows::{GpuData, GpuStruct, declare_settings, gpu_struct};
/// declare_settings! {
///     /// Settings of some technique.
///     pub struct HazeSettings {
///         /// Distance at which light has fallen to a third.
///         falloff_m: f32 = 0.5, 0.001..=10, in "metres";
///         /// Samples of each pixel.
///         taps: u32 = 16, 1..=64;
///     }
/// }
/// gpu_struct! {
///     /// `struct Haze { falloff_m: f32, taps: u32, per_metre: f32 }`
///     struct Haze {
///         settings: HazeSettings,
///         per_metre: f32,
///     }
/// }
/// let settings = HazeSettings::default();
/// let haze = Haze { per_metre: 1.0 / settings.falloff_m, settings };
/// assert_eq!(haze.bytes().len(), 12);
/// let fields = GpuStruct::new::<Haze>("Haze").fields;
/// assert_eq!(fields, [("falloff_m", "f32"), ("taps", "u32"), ("per_metre", "f32")]);
/// ```
#[macro_export]
macro_rules! gpu_struct {
    (
        $(#[$attribute:meta])*
        $vis:vis struct $Name:ident {
            $($(#[$field_attribute:meta])* $field:ident : $Type:ty),+ $(,)?
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Debug)]
        $vis struct $Name {
            $($(#[$field_attribute])* $vis $field: $Type,)+
        }

        impl $crate::GpuData for $Name {
            fn describe(_name: &'static str, fields: &mut ::std::vec::Vec<$crate::GpuField>) {
                $(<$Type as $crate::GpuData>::describe(stringify!($field), fields);)+
            }

            fn write(&self, bytes: &mut ::std::vec::Vec<u8>) {
                $($crate::GpuData::write(&self.$field, bytes);)+
            }
        }
    };
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::settings::{LightShadows, ShadowSettings};
    use crate::techniques::{
        ContactSettings, EvsmSettings, MsmSettings, PcssSettings, RaytracedSettings, ScreenSettings,
        SdsmSettings,
    };

    #[test]
    fn settings_are_written_as_the_scalars_that_are_described() {
        fn check<S: DescribeSettings>(settings: &S) {
            let fields = GpuStruct::new::<S>("").fields;
            let bytes = settings.bytes();
            assert_eq!(bytes.len(), SCALAR_BYTES * fields.len());
            for ((name, ty), scalar) in fields.into_iter().zip(bytes.chunks_exact(SCALAR_BYTES)) {
                let setting = S::settings().iter().find(|setting| setting.name == name).unwrap();
                let bits: [u8; SCALAR_BYTES] = scalar.try_into().unwrap();
                match (ty, setting.default_value()) {
                    ("f32", value) => {
                        assert_eq!(value.as_f64().unwrap() as f32, f32::from_ne_bytes(bits), "{name}");
                    }
                    (_, value) => {
                        let integer = value.as_u64().unwrap_or_else(|| u64::from(value.as_bool().unwrap()));
                        assert_eq!(integer, u64::from(u32::from_ne_bytes(bits)), "{name}");
                    }
                }
            }
        }
        check(&ShadowSettings::default());
        check(&LightShadows::new(0.into()));
        check(&PcssSettings::default());
        check(&EvsmSettings::default());
        check(&MsmSettings::default());
        check(&SdsmSettings::default());
        check(&RaytracedSettings::default());
        check(&ScreenSettings::default());
        check(&ContactSettings::default());
        let names = |fields: Vec<GpuField>| fields.into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        let light = names(GpuStruct::new::<LightShadows>("").fields);
        assert_eq!(light, ["casts", "strength", "importance"]);
    }

    #[test]
    fn a_field_of_another_type_in_wgsl_is_an_error() {
        let wgsl = "struct Contact { length_texels: f32, thickness: f32, max_steps: f32 }\n\
            @group(0) @binding(0) var<uniform> contact: Contact;";
        let module = naga::front::wgsl::parse_str(wgsl).unwrap();
        let error = GpuStruct::new::<ContactSettings>("Contact").check(&module).unwrap_err().to_string();
        assert_eq!(error, "field `max_steps` of WGSL struct `Contact` is of type `f32`, expected `u32`");
    }
}
