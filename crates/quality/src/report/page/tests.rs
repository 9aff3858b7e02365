#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
use super::super::fixture;
use super::html::encode_path;
use super::*;

fn report() -> Report {
    fixture::report(&[("pcf", 1.0), ("pcf", 4.0), ("pcss", 2.0)])
}

/// Returns all substrings between `from` and `to`.
fn all_between<'t>(text: &'t str, from: &str, to: &str) -> Vec<&'t str> {
    text.split(from).skip(1).filter_map(|rest| rest.split(to).next()).collect()
}

#[test]
fn the_same_report_gives_the_same_page() {
    assert_eq!(page(&report()), page(&report().clone()));
}

#[test]
fn every_case_is_linked_and_its_section_exists() {
    let page = page(&report());
    let links = all_between(&page, "<tr><th scope=\"row\"><a href=\"#", "\"");
    assert_eq!(links, ["case-1", "case-2", "case-3"]);
    for link in all_between(&page, "href=\"#", "\"") {
        assert_eq!(page.matches(&format!(" id=\"{link}\"")).count(), 1, "{link}");
    }
}

#[test]
fn ids_are_unique_and_labels_name_ids_that_exist() {
    let page = page(&report());
    let ids = all_between(&page, " id=\"", "\"");
    let labels = [all_between(&page, "labelledby=\"", "\""), all_between(&page, " for=\"", "\"")].concat();
    assert!(ids.iter().all(|id| ids.iter().filter(|other| other == &id).count() == 1), "{ids:?}");
    assert!(labels.iter().all(|label| ids.contains(label)), "{labels:?}");
}

#[test]
fn hostile_names_are_escaped() {
    let mut report = report();
    let hostile = "</script><script>alert(1)</script>&\"'";
    let case = &mut report.cases[1];
    for name in [&mut case.scene, &mut case.light, &mut case.view, &mut case.technique, &mut report.adapter] {
        *name = hostile.into();
    }
    case.images.as_mut().unwrap().truth = hostile.into();
    let page = page(&report);
    assert!(page.contains("&quot;distance_m&quot;: "), "{page}");
    let escaped = "&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;&quot;&#39;";
    assert!(!page.contains("<script>alert") && page.matches("</script>").count() == 1, "{page}");
    assert!(page.contains(&format!("<h3 id=\"case-2-name\">{}</h3>", [escaped; 4].join(", "))), "{page}");
    assert!(page.contains("src=\"%3C/script%3E%3Cscript%3Ealert%281%29%3C/script%3E%26%22%27\""), "{page}");
}

#[test]
fn paths_are_percent_encoded_and_name_no_scheme() {
    assert_eq!(encode_path("images/tower 15.png"), "images/tower%2015.png");
    assert_eq!(encode_path("a#b?c%d/é.png"), "a%23b%3Fc%25d/%C3%A9.png");
    assert_eq!(encode_path("javascript:alert"), "javascript%3Aalert");
}

#[test]
fn the_summary_links_to_the_worst_case() {
    let page = page(&report());
    let worst = "4.000 <small>tower, sun 15, view 1</small></a>";
    assert!(
        page.contains(&format!("<td class=\"n\">2.500</td><td class=\"n\"><a href=\"#case-2\">{worst}")),
        "{page}"
    );
    // There is no leak, so the worst value has no link.
    assert!(page.contains("<td class=\"n\">0.000</td><td class=\"n\">0.000</td>"), "{page}");
}

#[test]
fn cells_are_tinted_by_how_near_they_are_to_the_worst_of_their_column() {
    let page = page(&fixture::report(&[("pcf", 10.0), ("pcf", 4.0), ("pcf", 0.5)]));
    for cell in
        ["<td class=\"n t5\">10.000</td>", "<td class=\"n t2\">4.000</td>", "<td class=\"n\">0.500</td>"]
    {
        assert!(page.contains(cell), "{cell}\n{page}");
    }
    // Maps have the same size in all cases.
    assert!(page.contains("<td class=\"n\">64.0</td>"), "{page}");
}

#[test]
fn a_case_without_images_has_only_numbers() {
    let mut report = report();
    report.cases[0].images = None;
    let page = page(&report);
    let sections = all_between(&page, "<section class=\"case\"", "</section>");
    assert_eq!(sections.iter().map(|section| section.matches("<img").count()).collect::<Vec<_>>(), [0, 4, 4]);
    assert!(sections[0].contains("<dt>misclassified %</dt><dd>1.000</dd>"), "{}", sections[0]);
    assert!(sections[0].contains("<th scope=\"row\">0.5 to 1</th>"), "{}", sections[0]);
    assert!(sections[0].contains("<th scope=\"row\">translate, 10 km out</th>"), "{}", sections[0]);
}

#[test]
fn the_page_needs_nothing_from_outside_and_has_no_inline_handlers() {
    let page = page(&report());
    assert!(!page.contains("://") && !page.contains(" onclick") && !page.contains("@import"), "{page}");
    assert!(!all_between(&page, "src=\"", "\"").iter().any(|source| source.contains(':')), "{page}");
}

#[test]
fn a_report_without_cases_is_a_page() {
    let mut report = report();
    report.cases.clear();
    assert!(page(&report).contains("<p>0 cases, 0 techniques"));
}
