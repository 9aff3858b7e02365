//! Words for what `explained_lookup.wgsl` finds at a point.

use crate::technique::{ExplanationValues, ShadowFact};

/// The state of a light that its maps do not cover, and that of one that they do; 0 without shadows.
const NOT_COVERED: f32 = 1.0;
const COVERED: f32 = 2.0;

/// `LOOKUP_FACTS`: the values after these are those of the technique.
const LOOKUP_FACTS: usize = 15;

/// Returns the facts of a lookup, after those of the technique, which `own` finds in its own values.
pub(crate) fn describe(values: &ExplanationValues, own: fn(&[f32]) -> Vec<ShadowFact>) -> Vec<ShadowFact> {
    let (lookup, rest) = values.split_at(LOOKUP_FACTS);
    match lookup[0] {
        NOT_COVERED => vec![ShadowFact::new("maps that cover the point", [0.0], "")],
        COVERED => own(rest).into_iter().chain(lookup_facts(lookup)).collect(),
        _ => Vec::new(),
    }
}

fn lookup_facts(values: &[f32]) -> Vec<ShadowFact> {
    let &[
        _,
        strength,
        weight,
        x,
        y,
        texel_m,
        filter_half,
        depth,
        compared,
        stored,
        in_front_m,
        normal_bias,
        depth_bias,
        slope,
        min_slope,
    ] = values
    else {
        return Vec::new();
    };
    let mut facts = vec![
        ShadowFact::new("texel", [x, y], "texels"),
        ShadowFact::new("width of a texel", [texel_m], "m"),
        ShadowFact::new("half width of the filter", [filter_half], "texels"),
        ShadowFact::new("depth of the receiver", [depth], ""),
        ShadowFact::new("depth that is compared", [compared], ""),
        ShadowFact::new("stored depth", [stored], ""),
    ];
    if stored > 0.0 {
        facts.push(ShadowFact::new("stored surface in front by", [in_front_m], "m"));
    }
    facts.push(ShadowFact::new("bias along the normal", [normal_bias], "texels"));
    facts.push(ShadowFact::new("constant bias", [depth_bias], "texels"));
    facts.push(ShadowFact::new("slope that is followed", [slope], "texels per texel"));
    facts.push(ShadowFact::new("least slope", [min_slope], "texels per texel"));
    if weight < 1.0 {
        facts.push(ShadowFact::new("weight, blended with the next map", [weight], ""));
    }
    if strength < 1.0 {
        facts.push(ShadowFact::new("strength of the shadow", [strength], ""));
    }
    facts
}
