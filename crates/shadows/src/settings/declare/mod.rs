//! The declaration of structs and enums of settings.

mod check;
mod setting;

pub use check::SettingValue;

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use super::describe::{Setting, SettingType};
use crate::error::Error;

/// A type whose settings are declared by [`declare_settings!`](crate::declare_settings).
pub trait DescribeSettings {
    /// The description of a setting of this type, with the type's own defaults.
    const TYPE: SettingType;

    /// Checks every value.
    ///
    /// # Errors
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    fn validate(&self) -> Result<(), Error>;

    /// Appends the fields of a struct that are numbers or toggles, four bytes each, for a shader; nothing for other types.
    fn write_scalars(&self, _bytes: &mut Vec<u8>) {}

    /// Returns the fields of a struct; empty for other types.
    #[must_use]
    fn settings() -> &'static [Setting] {
        match Self::TYPE {
            SettingType::Struct(fields) => fields,
            _ => &[],
        }
    }
}

/// Returns a default as JSON, with the shortest numbers that mean it.
pub fn json<T: Serialize>(value: &T) -> Value {
    let text = serde_json::to_string(value).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// A field of a file that may be left out.
#[derive(Debug)]
pub struct Given<T>(pub Option<T>);

impl<T> Default for Given<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Given<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(|value| Self(Some(value)))
    }
}

/// Declares a struct or an enum of settings: each name, type, default, range, unit and line of documentation once.
///
/// A field is `name: type = default`, followed by what applies of `, low..=high` or `, power_of_two low..=high`,
/// `, in "unit"`, `, and "a further condition"` and `, alias "old name"`, in this order, and ends with `;`. Types are `bool`, `u32`, `f32`,
/// `f64`, another declared struct or enum, and `Vec` or `Option` of an `f32` or of one of those. Above a struct, `#[derive(Eq)]` adds
/// derives and `#[check(function)]` a check that is called after all fields were found in their ranges. A struct may begin with one field
/// without a default: `required light: LightRef;`. Variants of an enum are written `Name;`, `Name(type = example, ...);` or
/// `Name { fields };`, and `#[default(Name)]` above it implements `Default`.
///
/// The struct implements `Default`, `Serialize`, `Deserialize` (fields may be left out, unknown ones are errors) and
/// [`DescribeSettings`]; the documentation of each field ends with its range, unit and default. The crate that declares it needs
/// `serde` with the feature `derive`.
///
/// ```
/// use shadowgraph_shadows::{DescribeSettings, declare_settings};
/// declare_settings! {
///     /// Settings of some technique.
///     pub struct HazeSettings {
///         /// Distance at which light has fallen to a third.
///         falloff_m: f32 = 0.05, 0.001..=10, in "metres";
///         /// Samples of each pixel.
///         taps: u32 = 16, 1..=64;
///         /// Distribution of the samples.
///         pattern: Pattern = Pattern::Spiral;
///     }
/// }
/// declare_settings! {
///     /// Distribution of samples.
///     #[derive(Copy)]
///     #[default(Spiral)]
///     pub enum Pattern {
///         /// A Vogel spiral.
///         Spiral;
///         /// Rings around the centre.
///         Rings(u32 = 3, 1..=8);
///     }
/// }
/// let haze: HazeSettings = ron::from_str("(taps: 32, pattern: Rings(9))")?;
/// let error = haze.validate().unwrap_err().to_string();
/// assert_eq!(error, "invalid value: `pattern` is 9; allowed: 1 to 8");
/// assert_eq!(HazeSettings::settings()[0].allowed(), "0.001 to 10 (metres)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[macro_export]
macro_rules! declare_settings {
    // A struct whose fields all have defaults.
    (
        $(#[doc = $about:literal])*
        $(#[derive($($derive:ident),+)])?
        $(#[check($check:path)])?
        $vis:vis struct $Name:ident {
            $(
                $(#[doc = $doc:literal])*
                $field:ident : $T:ident $(<$A:ident>)? = $default:expr
                    $(, $low:literal ..= $high:literal)?
                    $(, power_of_two $least:literal ..= $most:literal)?
                    $(, in $unit:literal)?
                    $(, and $note:literal)?
                    $(, alias $alias:literal)? ;
            )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize, ::serde::Deserialize $($(, $derive)+)?)]
        #[serde(deny_unknown_fields, default)]
        $vis struct $Name {
            $(
                $(#[doc = $doc])*
                #[doc = ""]
                $(#[doc = concat!("Range: ", $low, " to ", $high, ".")])?
                $(#[doc = concat!("A power of two from ", $least, " to ", $most, ".")])?
                $(#[doc = concat!("Unit: ", $unit, ".")])?
                $(#[doc = concat!("Condition: ", $note, ".")])?
                #[doc = concat!("Default: `", stringify!($default), "`.")]
                $(#[serde(alias = $alias)])?
                $vis $field: $T $(<$A>)?,
            )*
        }

        impl ::core::default::Default for $Name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl $Name {
            /// Description of each field.
            $vis const SETTINGS: &'static [$crate::Setting] = &[$(
                $crate::describe_setting!(
                    @setting stringify!($field), [$($doc)*], [$($unit)?], [$($note)?],
                    $T $(<$A>)?, $default $(, range $low $high)? $(, powers $least $most)?
                ),
            )*];
        }

        impl $crate::DescribeSettings for $Name {
            const TYPE: $crate::SettingType = $crate::SettingType::Struct(Self::SETTINGS);

            fn validate(&self) -> ::core::result::Result<(), $crate::Error> {
                if let [$($field),*] = Self::SETTINGS {
                    $($crate::SettingValue::check(&self.$field, $field)?;)*
                }
                $($check(self)?;)?
                ::core::result::Result::Ok(())
            }

            fn write_scalars(&self, bytes: &mut ::std::vec::Vec<u8>) {
                $($crate::SettingValue::write_scalar(&self.$field, bytes);)*
            }
        }
    };

    // A struct with one field that a file has to give.
    (
        $(#[doc = $about:literal])*
        $vis:vis struct $Name:ident {
            $(#[doc = $key_doc:literal])*
            required $key:ident : $K:ident;
            $(
                $(#[doc = $doc:literal])*
                $field:ident : $T:ident $(<$A:ident>)? = $default:expr
                    $(, $low:literal ..= $high:literal)?
                    $(, in $unit:literal)?
                    $(, and $note:literal)? ;
            )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize)]
        $vis struct $Name {
            $(#[doc = $key_doc])*
            #[doc = ""]
            #[doc = "Required."]
            $vis $key: $K,
            $(
                $(#[doc = $doc])*
                #[doc = ""]
                $(#[doc = concat!("Range: ", $low, " to ", $high, ".")])?
                $(#[doc = concat!("Unit: ", $unit, ".")])?
                $(#[doc = concat!("Condition: ", $note, ".")])?
                #[doc = concat!("Default: `", stringify!($default), "`.")]
                $vis $field: $T $(<$A>)?,
            )*
        }

        impl $Name {
            /// Description of each field.
            $vis const SETTINGS: &'static [$crate::Setting] = &[
                $crate::Setting {
                    name: stringify!($key),
                    ty: <$K as $crate::DescribeSettings>::TYPE,
                    unit: "",
                    note: "",
                    about: concat!($($key_doc,)*).trim_ascii(),
                },
                $($crate::describe_setting!(
                    @setting stringify!($field), [$($doc)*], [$($unit)?], [$($note)?],
                    $T $(<$A>)?, $default $(, range $low $high)?
                ),)*
            ];

            /// Creates settings with all defaults.
            #[must_use]
            $vis fn new($key: $K) -> Self {
                Self { $key, $($field: $default,)* }
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $Name {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> ::core::result::Result<Self, D::Error> {
                #[derive(::serde::Deserialize)]
                #[serde(deny_unknown_fields)]
                struct $Name {
                    $key: $K,
                    $(
                        #[serde(default)]
                        $field: $crate::__settings::Given<$T $(<$A>)?>,
                    )*
                }
                let read = $Name::deserialize(deserializer)?;
                let mut settings = Self::new(read.$key);
                $(if let ::core::option::Option::Some(value) = read.$field.0 {
                    settings.$field = value;
                })*
                ::core::result::Result::Ok(settings)
            }
        }

        impl $crate::DescribeSettings for $Name {
            const TYPE: $crate::SettingType = $crate::SettingType::Struct(Self::SETTINGS);

            fn validate(&self) -> ::core::result::Result<(), $crate::Error> {
                if let [$key, $($field),*] = Self::SETTINGS {
                    $crate::SettingValue::check(&self.$key, $key)?;
                    $($crate::SettingValue::check(&self.$field, $field)?;)*
                }
                ::core::result::Result::Ok(())
            }

            fn write_scalars(&self, bytes: &mut ::std::vec::Vec<u8>) {
                $($crate::SettingValue::write_scalar(&self.$field, bytes);)*
            }
        }
    };

    // An enum.
    (
        $(#[doc = $about:literal])*
        $(#[derive($($derive:ident),+)])?
        $(#[default($Default:ident)])?
        $vis:vis enum $Name:ident {
            $(
                $(#[doc = $doc:literal])*
                $Variant:ident
                    $((
                        $P:ident $(<$B:ident>)? = $payload:expr
                            $(, $low:literal ..= $high:literal)?
                            $(, in $unit:literal)?
                            $(, and $note:literal)?
                    ))?
                    $({ $(
                        $(#[doc = $field_doc:literal])*
                        $field:ident : $T:ident = $default:expr
                            $(, $min:literal ..= $max:literal)?
                            $(, power_of_two $least:literal ..= $most:literal)?
                            $(, in $field_unit:literal)?
                            $(, and $field_note:literal)? ;
                    )* })? ;
            )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize, ::serde::Deserialize $($(, $derive)+)?)]
        #[serde(deny_unknown_fields)]
        $vis enum $Name {
            $(
                $(#[doc = $doc])*
                $(
                    #[doc = ""]
                    $(#[doc = concat!("Range: ", $low, " to ", $high, ".")])?
                    $(#[doc = concat!("Unit: ", $unit, ".")])?
                    $(#[doc = concat!("Condition: ", $note, ".")])?
                    #[doc = concat!("For example `", stringify!($payload), "`.")]
                )?
                $Variant $(($P $(<$B>)?))? $({ $(
                    $(#[doc = $field_doc])*
                    #[doc = ""]
                    $(#[doc = concat!("Range: ", $min, " to ", $max, ".")])?
                    $(#[doc = concat!("A power of two from ", $least, " to ", $most, ".")])?
                    $(#[doc = concat!("Unit: ", $field_unit, ".")])?
                    $(#[doc = concat!("Condition: ", $field_note, ".")])?
                    $field: $T,
                )* })?,
            )*
        }

        $(impl ::core::default::Default for $Name {
            fn default() -> Self {
                Self::$Default
            }
        })?

        impl $Name {
            /// Description of each variant.
            $vis const VARIANTS: &'static [$crate::Variant] = &[$(
                $crate::Variant {
                    name: stringify!($Variant),
                    about: concat!($($doc,)*).trim_ascii(),
                    payload: $crate::describe_setting!(
                        @payload
                        $((@setting "", [], [$($unit)?], [$($note)?], $P $(<$B>)?, $payload $(, range $low $high)?))?
                        $({ $(
                            (@setting stringify!($field), [$($field_doc)*], [$($field_unit)?], [$($field_note)?],
                                $T, $default $(, range $min $max)? $(, powers $least $most)?)
                        )* })?
                    ),
                },
            )*];
        }

        impl $crate::DescribeSettings for $Name {
            const TYPE: $crate::SettingType =
                $crate::SettingType::Enum(|| $crate::__settings::first_variant(Self::VARIANTS), Self::VARIANTS);

            fn validate(&self) -> ::core::result::Result<(), $crate::Error> {
                let mut variants = Self::VARIANTS.iter();
                $(
                    let payload = variants.next().map(|variant| variant.payload);
                    let _used = &payload;
                    if let Self::$Variant
                        $(($crate::describe_setting!(@payload_name $P value)))?
                        $({ $($field),* })? = self
                    {
                        $(
                            if let ::core::option::Option::Some($crate::Payload::Value(setting)) = payload {
                                $crate::SettingValue::check($crate::describe_setting!(@payload_name $P value), setting)?;
                            }
                        )?
                        $(
                            if let ::core::option::Option::Some($crate::Payload::Fields(settings)) = payload {
                                let mut settings = settings.iter();
                                $(if let ::core::option::Option::Some(setting) = settings.next() {
                                    $crate::SettingValue::check($field, setting)?;
                                })*
                            }
                        )?
                    }
                )*
                ::core::result::Result::Ok(())
            }
        }
    };
}
