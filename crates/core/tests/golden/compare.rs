//! Compares a text with the accepted one.

use std::path::PathBuf;

const ACCEPT: &str =
    concat!("UPDATE_GOLDEN=1 cargo test -p ", env!("CARGO_PKG_NAME"), " --no-default-features --test golden");

/// Checks `text` against `golden/NAME.txt`, or writes it there if `UPDATE_GOLDEN` is set.
///
/// # Panics
/// If they differ, or if there is no accepted text.
pub(crate) fn check(name: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{name}.txt"));
    for line in text.lines() {
        assert!(line.chars().count() <= 110, "wider than 110 columns: {line}");
        assert!(line.trim_end() == line, "blanks at the end: {line:?}");
    }
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, text).unwrap();
        return;
    }
    let Ok(accepted) = std::fs::read_to_string(&path) else {
        panic!("{name}: nothing is accepted yet. Read the text, then accept it with\n  {ACCEPT}\n\n{text}");
    };
    // A checkout may end lines otherwise.
    let accepted = accepted.replace("\r\n", "\n");
    if accepted != text {
        let difference = difference(&accepted, text);
        panic!(
            "{name}: the text is another (-: accepted, +: now). If it should be, accept it with\n  {ACCEPT}\n\n{difference}"
        );
    }
}

/// Compares both texts line by line, by their longest common subsequence.
fn difference(old: &str, new: &str) -> String {
    let (old, new): (Vec<_>, Vec<_>) = (old.lines().collect(), new.lines().collect());
    // `common[i][j]`: how many lines `old[i..]` and `new[j..]` have in common.
    let mut common = vec![vec![0; new.len() + 1]; old.len() + 1];
    for i in (0..old.len()).rev() {
        for j in (0..new.len()).rev() {
            common[i][j] = match old[i] == new[j] {
                true => common[i + 1][j + 1] + 1,
                false => common[i + 1][j].max(common[i][j + 1]),
            };
        }
    }
    let (mut i, mut j, mut out) = (0, 0, String::new());
    let mut line = |mark, text| out += &format!("{mark} {text}\n");
    while i < old.len() || j < new.len() {
        if i < old.len() && j < new.len() && old[i] == new[j] {
            line(' ', old[i]);
            (i, j) = (i + 1, j + 1);
        } else if j == new.len() || i < old.len() && common[i + 1][j] >= common[i][j + 1] {
            line('-', old[i]);
            i += 1;
        } else {
            line('+', new[j]);
            j += 1;
        }
    }
    out
}

#[test]
fn a_difference_shows_removed_and_added_lines() {
    assert_eq!(difference("a\nb\nc\n", "a\nx\nc\nd\n"), "  a\n- b\n+ x\n  c\n+ d\n");
}

#[test]
#[should_panic(expected = "nothing is accepted yet")]
fn a_missing_text_fails() {
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        panic!("nothing is accepted yet, and this test accepts nothing");
    }
    check("no such lesson", "text\n");
}
