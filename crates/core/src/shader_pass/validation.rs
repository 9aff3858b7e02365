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
    let notes = drawn.lines().filter_map(|drawn| drawn.trim_start().strip_prefix("= "));
    let notes: String = notes.map(|note| format!(" ({note})")).collect();
    match marked(drawn) {
        Some((number, text)) if number == line => {
            format!("line {line}, column {column}: {}{notes}, in `{text}`", joined(what))
        }
        // Of several lines, the one in which the mistake is.
        Some((number, text)) => format!("line {number}: {}{notes}, in `{text}`", joined(what)),
        None => format!("line {line}, column {column}: {}{notes}", joined(what)),
    }
}

/// The number and the text of the line above the first mark `^`. Lines on the left tie together what spans several lines.
fn marked(drawn: &str) -> Option<(&str, &str)> {
    let lines = || drawn.lines();
    let is_mark =
        |line: &str| line.trim_start().starts_with('│') && line.contains('^') && !line.contains('╰');
    let mark = lines().position(is_mark)?;
    let (number, text) = lines().nth(mark.checked_sub(1)?)?.trim_start().split_once(" │ ")?;
    Some((number, text.trim_start_matches(['│', '╭', ' ']).trim_end()))
}

#[cfg(test)]
mod tests {
    use super::in_a_line;

    #[test]
    fn what_is_drawn_below_a_mistake_becomes_words() {
        let drawn = "\nShader 'red' parsing error: no definition in scope for identifier: `hallf`\n  ┌─ wgsl:12:50\n   │\n\
                     12 │   let a = 1 ^ hallf();\n   │               ^^^^^ unknown identifier\n   │\n   = note: it is not there\n";
        assert_eq!(
            in_a_line(drawn),
            "line 12, column 50: no definition in scope for identifier: `hallf` (note: it is not there), in `let a = 1 ^ hallf();`"
        );
    }

    #[test]
    fn of_several_lines_the_one_with_the_mistake_is_told() {
        let drawn = "Shader validation error: Function [0] 'half' is invalid\n  ┌─ half:1:1\n  │  \n1 │ ╭ fn half() -> vec4f {\n\
                     2 │ │     return vec2f(0.5);\n  │ │            ^^^^^^^^^^ naga::ir::Expression [1]\n3 │ │ }\n\
                       │ ╰─^ naga::ir::Function [0]\n  │  \n  = The types differ\n";
        assert_eq!(
            in_a_line(drawn),
            "line 2: Function [0] 'half' is invalid (The types differ), in `return vec2f(0.5);`"
        );
    }

    #[test]
    fn what_has_no_place_stays_as_it_is() {
        assert_eq!(in_a_line("no such\n  entry point"), "no such entry point");
        assert_eq!(in_a_line("odd ┌─ wgsl"), "odd ┌─ wgsl");
        assert_eq!(in_a_line("odd\n ┌─ wgsl\n"), "odd ┌─ wgsl");
    }
}
