//! Changes of settings that may make a shadow right.

use shadowgraph_shadows::{CullSettings, MAX_CASCADES, ShadowFilter, ShadowSettings, VirtualSettings};

/// Returns settings that each differ in one value, with that value as in a settings file. The setting of a map is that of the light's kind.
pub(super) fn changes(settings: &ShadowSettings, is_directional: bool) -> Vec<(String, ShadowSettings)> {
    let mut changes = Vec::new();
    let mut change = |name: String, change: &dyn Fn(&mut ShadowSettings)| {
        let mut changed = settings.clone();
        change(&mut changed);
        if changed != *settings && changed.validate().is_ok() {
            changes.push((in_file(&name), changed));
        }
    };
    let narrowest = ShadowFilter::ALL[0];
    for factor in [2, 4, 16] {
        if is_directional {
            let size_px = factor * settings.cascades.map_size_px;
            change(format!("cascades.map_size_px: {size_px}"), &|changed| {
                changed.cascades.map_size_px = size_px
            });
        } else {
            let size_px = factor * settings.atlas.map_size_px;
            change(format!("atlas.map_size_px: {size_px}"), &|changed| changed.atlas.map_size_px = size_px);
        }
    }
    if is_directional {
        for count in [settings.cascades.count + 1, MAX_CASCADES] {
            change(format!("cascades.count: {count}"), &|changed| changed.cascades.count = count);
        }
        change(format!("cascades.filter: {narrowest:?}"), &|changed| changed.cascades.filter = narrowest);
    } else {
        change(format!("atlas.filter: {narrowest:?}"), &|changed| changed.atlas.filter = narrowest);
    }
    for factor in [0.25, 2.0] {
        let distance_m = factor * settings.distance_m;
        change(format!("distance_m: {distance_m:.1}"), &|changed| changed.distance_m = distance_m);
    }
    for factor in [0.0, 0.5, 2.0] {
        let texels = factor * settings.bias.normal_texels;
        change(format!("bias.normal_texels: {texels}"), &|changed| changed.bias.normal_texels = texels);
        let texels = factor * settings.bias.depth_texels;
        change(format!("bias.depth_texels: {texels}"), &|changed| changed.bias.depth_texels = texels);
        let slope = factor * settings.bias.min_slope;
        change(format!("bias.min_slope: {slope}"), &|changed| changed.bias.min_slope = slope);
    }
    let supersample = !settings.supersample;
    change(format!("supersample: {supersample}"), &|changed| changed.supersample = supersample);
    let close_creases = !settings.close_creases;
    change(format!("close_creases: {close_creases}"), &|changed| changed.close_creases = close_creases);
    change("cull: (unseen: false, covered: false)".into(), &|changed| changed.cull = CullSettings::NONE);
    if let Ok(own) = settings.techniques.get::<VirtualSettings>() {
        let mut virtual_change = |name: String, own: VirtualSettings| {
            change(format!("techniques.virtual.{name}"), &|changed| {
                // Out of range, it is no change.
                let _ = changed.techniques.set(&own);
            });
        };
        let pool_mib = 2 * own.pool_mib;
        virtual_change(format!("pool_mib: {pool_mib}"), VirtualSettings { pool_mib, ..own.clone() });
        let level_bias = own.level_bias - 1.0;
        virtual_change(format!("level_bias: {level_bias}"), VirtualSettings { level_bias, ..own.clone() });
        virtual_change(format!("filter: {narrowest:?}"), VirtualSettings { filter: narrowest, ..own });
    }
    changes
}

/// Returns the text of a settings file that sets a value: `(cascades: (count: 4))` for `cascades.count: 4`.
fn in_file(setting: &str) -> String {
    let (path, value) = setting.split_once(": ").unwrap_or((setting, ""));
    let mut names = path.rsplit('.');
    let last = names.next().unwrap_or_default();
    names.fold(format!("({last}: {value})"), |inner, name| match name {
        "techniques" => format!("(techniques: {{{inner}}})"),
        technique if path.starts_with("techniques.") => format!("\"{technique}\": {inner}"),
        name => format!("({name}: {inner})"),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn each_change_is_valid_and_of_another_value() {
        for is_directional in [false, true] {
            let changes = changes(&ShadowSettings::default(), is_directional);
            let mut names: Vec<_> = changes.iter().map(|(name, _)| name.clone()).collect();
            assert!(changes.iter().all(|(_, changed)| *changed != ShadowSettings::default()));
            for (text, changed) in &changes {
                let read: ShadowSettings = ron::from_str(text).unwrap();
                let of_virtual =
                    |settings: &ShadowSettings| settings.techniques.get::<VirtualSettings>().unwrap();
                assert_eq!(of_virtual(&read), of_virtual(changed), "{text}");
                let techniques = changed.techniques.clone();
                assert_eq!(ShadowSettings { techniques, ..read }, *changed, "{text}");
            }
            assert!(names.len() > 8, "{names:?}");
            names.sort();
            names.dedup();
            assert_eq!(names.len(), changes.len(), "{names:?}");
        }
    }
}
