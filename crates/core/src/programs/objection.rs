//! What wgpu says against a shader, in a line.

use std::error::Error as _;

/// The causes of an objection, without saying which of wgpu's functions objects.
pub(super) fn words(objection: &wgpu::Error) -> String {
    let mut told = String::new();
    for cause in std::iter::successors(objection.source(), |&cause| cause.source()) {
        let words = in_a_line(cause.to_string().trim());
        // A cause may have been told with the one that it led to.
        if words.starts_with("In ") || told.contains(&words) {
            continue;
        }
        told += if told.is_empty() { "" } else { ": " };
        told += &words;
    }
    if told.is_empty() { in_a_line(&objection.to_string()) } else { told }
}

/// Puts what a compiler draws below a mistake into words: `line 2, column 7: what is wrong, in its line of the text`.
fn in_a_line(words: &str) -> String {
    let joined = |words: &str| words.lines().map(str::trim).collect::<Vec<_>>().join(" ").trim().to_owned();
    let Some((heading, (place, drawn))) =
        words.split_once("┌─ ").and_then(|(heading, rest)| Some((heading, rest.split_once('\n')?)))
    else {
        return joined(words);
    };
    let mut place = place.rsplitn(3, ':');
    let (Some(column), Some(line)) = (place.next(), place.next()) else { return joined(words) };
    let what = heading.split_once(" error: ").map_or(heading, |(_, what)| what);
    let number = line.to_owned() + " │ ";
    let text = drawn.lines().find_map(|drawn| drawn.trim_start().strip_prefix(&number));
    let notes = drawn.lines().filter_map(|drawn| drawn.trim_start().strip_prefix("= "));
    let notes: String = notes.map(|note| format!(" ({note})")).collect();
    let text = text.map_or(String::new(), |text| format!(", in `{}`", text.trim()));
    format!("line {line}, column {column}: {}{notes}{text}", joined(what))
}

#[cfg(test)]
mod tests {
    use super::in_a_line;

    #[test]
    fn what_is_drawn_below_a_mistake_becomes_words() {
        let drawn = "\nShader 'red' parsing error: no definition in scope for identifier: `hallf`\n  ┌─ wgsl:12:50\n   │\n\
                     12 │   let a = hallf();\n   │           ^^^^^ unknown identifier\n   │\n   = note: it is not there\n";
        assert_eq!(
            in_a_line(drawn),
            "line 12, column 50: no definition in scope for identifier: `hallf` (note: it is not there), in `let a = hallf();`"
        );
    }

    #[test]
    fn what_has_no_place_stays_as_it_is() {
        assert_eq!(in_a_line("no such\n  entry point"), "no such entry point");
        assert_eq!(in_a_line("odd ┌─ wgsl"), "odd ┌─ wgsl");
        assert_eq!(in_a_line("odd\n ┌─ wgsl\n"), "odd ┌─ wgsl");
    }
}
