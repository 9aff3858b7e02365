//! Differences as an HTML page.

use super::{Diff, Difference, Subject};
use crate::html::escape;
use std::fmt::Write as _;

const STYLE: &str = include_str!("page.css");

impl Diff {
    /// Returns the differences as one self-contained HTML page; `before` and `after` are the names of the frames.
    pub fn to_html(&self, before: &str, after: &str) -> String {
        let (before, after) = (escape(before), escape(after));
        let mut out = format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{before} and {after}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>From {before} to {after}</h1>\n"
        );
        out.push_str("<p>");
        for subject in Subject::ALL {
            let changes = self.about(subject).filter(|difference| !difference.only_numbers).count();
            let _ = write!(out, "<a href=\"#{0}\">{changes} {0}</a> ", subject.plural());
        }
        out.push_str("differ.</p>\n");
        if let Some(contents) = &self.contents {
            let _ = writeln!(out, "<p>{}</p>", escape(contents.to_text().trim()));
        }
        for subject in Subject::ALL {
            let _ = writeln!(out, "<section id=\"{0}\">\n<h2>{0}</h2>", subject.plural());
            if self.about(subject).next().is_none() {
                out.push_str("<p>They do not differ.</p>\n</section>\n");
                continue;
            }
            let (shifted, other): (Vec<&Difference>, Vec<&Difference>) =
                self.about(subject).partition(|difference| difference.only_numbers);
            table(&mut out, &other, [&before, &after]);
            if let Some(count) = self.describe_number_changes(subject) {
                let _ = writeln!(out, "<details><summary>{count}</summary>");
                table(&mut out, &shifted, [&before, &after]);
                out.push_str("</details>\n");
            }
            out.push_str("</section>\n");
        }
        out.push_str("</body>\n</html>\n");
        out
    }
}

fn table(out: &mut String, differences: &[&Difference], [before, after]: [&str; 2]) {
    if differences.is_empty() {
        return;
    }
    out.push_str("<table>\n<thead><tr><th scope=\"col\">name</th><th scope=\"col\">");
    let _ = writeln!(out, "{before}</th><th scope=\"col\">{after}</th></tr></thead>\n<tbody>");
    differences.iter().for_each(|difference| row(out, difference));
    out.push_str("</tbody>\n</table>\n");
}

fn row(out: &mut String, Difference { name, before, after, .. }: &Difference) {
    let class = match (before, after) {
        (Some(_), Some(_)) => "changed",
        (Some(_), None) => "removed",
        _ => "added",
    };
    let cell = |side: &Option<String>, tag: &str| match side {
        None => "<td class=\"none\">missing</td>".to_owned(),
        Some(fact) if fact.is_empty() => format!("<td><{tag}>present</{tag}></td>"),
        Some(fact) => format!("<td><{tag}>{}</{tag}></td>", escape(fact)),
    };
    let (was, is) = (cell(before, "del"), cell(after, "ins"));
    let _ = writeln!(out, "<tr class=\"{class}\"><th scope=\"row\">{}</th>{was}{is}</tr>", escape(name));
}
