//! Validation errors of wgpu, in one line.

use std::error::Error as _;

/// Joins the causes of a validation error, without the name of the wgpu function that reports it.
pub(super) fn describe(error: &wgpu::Error) -> String {
    let mut message = String::new();
    for cause in std::iter::successors(error.source(), |&cause| cause.source()) {
        let text = in_one_line(cause.to_string().trim());
        // The cause before may have repeated this one.
        if text.starts_with("In ") || message.contains(&text) {
            continue;
        }
        message += if message.is_empty() { "" } else { ": " };
        message += &text;
    }
    if message.is_empty() { in_one_line(&error.to_string()) } else { message }
}

/// Turns a compiler's annotated source excerpt into `line 2, column 7: what is wrong, in its line of the source`.
fn in_one_line(report: &str) -> String {
    let joined = |text: &str| text.lines().map(str::trim).collect::<Vec<_>>().join(" ").trim().to_owned();
    let Some((heading, (location, excerpt))) =
        report.split_once("┌─ ").and_then(|(heading, rest)| Some((heading, rest.split_once('\n')?)))
    else {
        return joined(report);
    };
    let mut location = location.rsplitn(3, ':');
    let (Some(column), Some(line)) = (location.next(), location.next()) else { return joined(report) };
    let what = heading.split_once(" error: ").map_or(heading, |(_, what)| what);
    let notes = excerpt.lines().filter_map(|line| line.trim_start().strip_prefix("= "));
    let notes: String = notes.map(|note| format!(" ({note})")).collect();
    match marked_line(excerpt) {
        Some((number, text)) if number == line => {
            format!("line {line}, column {column}: {}{notes}, in `{text}`", joined(what))
        }
        // The excerpt spans several lines: name the one with the error.
        Some((number, text)) => format!("line {number}: {}{notes}, in `{text}`", joined(what)),
        None => format!("line {line}, column {column}: {}{notes}", joined(what)),
    }
}

/// Returns the number and the text of the source line above the first mark `^`. Braces in the left margin join the lines
/// of a span.
fn marked_line(excerpt: &str) -> Option<(&str, &str)> {
    let lines = || excerpt.lines();
    let is_mark =
        |line: &str| line.trim_start().starts_with('│') && line.contains('^') && !line.contains('╰');
    let mark = lines().position(is_mark)?;
    let (number, text) = lines().nth(mark.checked_sub(1)?)?.trim_start().split_once(" │ ")?;
    Some((number, text.trim_start_matches(['│', '╭', ' ']).trim_end()))
}

#[cfg(test)]
mod tests {
    use super::in_one_line;

    #[test]
    fn an_annotated_excerpt_becomes_one_line() {
        let report = "\nShader 'red' parsing error: no definition in scope for identifier: `hallf`\n  ┌─ wgsl:12:50\n   │\n\
                     12 │   let a = 1 ^ hallf();\n   │               ^^^^^ unknown identifier\n   │\n   = note: it is not there\n";
        assert_eq!(
            in_one_line(report),
            "line 12, column 50: no definition in scope for identifier: `hallf` (note: it is not there), in `let a = 1 ^ hallf();`"
        );
    }

    #[test]
    fn of_several_lines_the_one_with_the_error_is_named() {
        let report = "Shader validation error: Function [0] 'half' is invalid\n  ┌─ half:1:1\n  │  \n1 │ ╭ fn half() -> vec4f {\n\
                     2 │ │     return vec2f(0.5);\n  │ │            ^^^^^^^^^^ naga::ir::Expression [1]\n3 │ │ }\n\
                       │ ╰─^ naga::ir::Function [0]\n  │  \n  = The types differ\n";
        assert_eq!(
            in_one_line(report),
            "line 2: Function [0] 'half' is invalid (The types differ), in `return vec2f(0.5);`"
        );
    }

    #[test]
    fn a_message_without_a_location_is_unchanged() {
        assert_eq!(in_one_line("no such\n  entry point"), "no such entry point");
        assert_eq!(in_one_line("odd ┌─ wgsl"), "odd ┌─ wgsl");
        assert_eq!(in_one_line("odd\n ┌─ wgsl\n"), "odd ┌─ wgsl");
    }
}
