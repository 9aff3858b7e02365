//! The description of one setting in the expansion of `declare_settings!`.

/// Expands to the description of a setting, of its type, or of what a variant carries. A part of
/// [`declare_settings!`](crate::declare_settings).
#[doc(hidden)]
#[macro_export]
macro_rules! describe_setting {
    (@setting $name:expr, [$($doc:literal)*], [$($unit:literal)?], [$($note:literal)?], $($ty:tt)+) => {
        $crate::Setting {
            name: $name,
            ty: $crate::describe_setting!(@type $($ty)+),
            unit: concat!($($unit)?),
            note: concat!($($note)?),
            about: concat!($($doc,)*).trim_ascii(),
        }
    };

    (@payload) => { $crate::Payload::Empty };
    (@payload ($($setting:tt)+)) => {{
        const SETTING: &$crate::Setting = &$crate::describe_setting!($($setting)+);
        $crate::Payload::Value(SETTING)
    }};
    (@payload { $(($($setting:tt)+))* }) => {{
        const SETTINGS: &[$crate::Setting] = &[$($crate::describe_setting!($($setting)+),)*];
        $crate::Payload::Fields(SETTINGS)
    }};

    // Repeats a name once for each payload.
    (@payload_name $type:ident $name:ident) => { $name };

    (@type bool, $default:expr) => { $crate::SettingType::Toggle($default) };
    (@type u32, $default:expr, range $low:literal $high:literal) => {
        $crate::SettingType::Integer($default as i64, $low, $high)
    };
    (@type u32, $default:expr, powers $low:literal $high:literal) => {
        $crate::SettingType::PowerOfTwo($default as i64, $low, $high)
    };
    (@type f32, $default:expr, range $low:literal $high:literal) => {
        $crate::SettingType::Number($default as f64, $low as f64, $high as f64)
    };
    (@type f64, $default:expr, range $low:literal $high:literal) => {
        $crate::SettingType::Number($default as f64, $low as f64, $high as f64)
    };
    (@type Vec<f32>, $default:expr, range $low:literal $high:literal) => {
        $crate::SettingType::List(
            || { let value: Vec<f32> = $default; $crate::__settings::json(&value) },
            &$crate::SettingType::Number($low as f64, $low as f64, $high as f64),
        )
    };
    (@type Vec<$Item:ident>, $default:expr) => {
        $crate::SettingType::List(
            || { let value: Vec<$Item> = $default; $crate::__settings::json(&value) },
            &<$Item as $crate::DescribeSettings>::TYPE,
        )
    };
    (@type Option<f32>, $default:expr, range $low:literal $high:literal) => {
        $crate::SettingType::Optional(&$crate::SettingType::Number($low as f64, $low as f64, $high as f64))
    };
    (@type Option<$Inner:ident>, $default:expr) => {
        $crate::SettingType::Optional(&<$Inner as $crate::DescribeSettings>::TYPE)
    };
    (@type $Type:ident, $default:expr) => {
        <$Type as $crate::DescribeSettings>::TYPE.with_default(|| $crate::__settings::json(&{
            let value: $Type = $default;
            value
        }))
    };
}
