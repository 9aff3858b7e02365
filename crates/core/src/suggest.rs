//! Suggestions for a name that is not known.

/// Names that are less similar than this are not suggested; 1 is equal.
const MIN_SIMILARITY: f64 = 0.75;

/// Returns the known name that is most similar to `name`; `None` if none is similar enough.
///
/// ```
/// assert_eq!(shadowgraph_core::closest_name("Forwards", ["forward", "deferred"]), Some("forward"));
/// ```
pub fn closest_name<N: AsRef<str>>(name: &str, known: impl IntoIterator<Item = N>) -> Option<N> {
    let name = name.to_lowercase();
    let rated = known.into_iter().map(|known| (similarity(&name, &known.as_ref().to_lowercase()), known));
    let closest = rated.filter(|(similarity, _)| *similarity > MIN_SIMILARITY);
    closest.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, known)| known)
}

/// Returns the end of an error about an unknown name: the most similar known name, or else all of them.
///
/// ```
/// use shadowgraph_core::did_you_mean;
/// assert_eq!(did_you_mean("forwards", ["forward", "deferred"]), "; did you mean `forward`?");
/// assert_eq!(did_you_mean("?", ["forward", "deferred"]), "; expected one of: forward, deferred");
/// ```
pub fn did_you_mean<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    match closest_name(name, known.iter().copied()) {
        Some(closest) => format!("; did you mean `{closest}`?"),
        None if known.is_empty() => "; none is known".into(),
        None => format!("; expected one of: {}", known.join(", ")),
    }
}

fn similarity(a: &str, b: &str) -> f64 {
    // One typing error in a short name weighs too much otherwise.
    if b.len() > 2 && strsim::osa_distance(a, b) == 1 { 0.95 } else { strsim::jaro_winkler(a, b) }
}
