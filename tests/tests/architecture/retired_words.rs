//! Checks that no retired word of `tests/retired_words.txt` is left in the sources and documents.

use regex::bytes::{Regex, RegexSet, RegexSetBuilder};
use shadowgraph_tests::repository;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

const LIST: &str = "tests/retired_words.txt";
const EXTENSIONS: [&str; 9] = ["rs", "wgsl", "md", "ron", "toml", "js", "css", "html", "py"];
const EXCEPT: [&str; 1] = ["CHANGELOG.md"];

/// A line of the list.
struct Word {
    kind: String,
    pattern: String,
    instead: String,
    /// Beginnings of the paths in which it is allowed.
    allowed: Vec<String>,
}

impl Word {
    fn parse(line: &str) -> Result<Self, String> {
        let error = |what: &str| format!("{what} in the line `{line}` of {LIST}");
        let columns: Vec<&str> = line.split('\t').collect();
        let (&[kind, pattern, instead], rest) =
            columns.split_first_chunk().ok_or_else(|| error("fewer than three columns"))?;
        let allowed = match rest {
            [] => Vec::new(),
            [allowed] => {
                let (paths, _) = allowed.split_once(": ").ok_or_else(|| error("no reason"))?;
                paths.split(", ").map(str::to_owned).collect()
            }
            _ => return Err(error("more than four columns")),
        };
        let word =
            Self { kind: kind.to_owned(), pattern: pattern.to_owned(), instead: instead.to_owned(), allowed };
        word.expression().ok_or_else(|| error("unknown kind"))?;
        Ok(word)
    }

    fn expression(&self) -> Option<String> {
        let pattern = &self.pattern;
        Some(match self.kind.as_str() {
            "identifier" => format!(r"\b{pattern}\b"),
            "type" => format!(r"\b(struct|enum|union|trait|type) {pattern}\b"),
            "function" => format!(r"\bfn {pattern}\b"),
            "code" | "wgsl" => pattern.clone(),
            "phrase" => format!("(?i){pattern}"),
            _ => return None,
        })
    }

    fn is_phrase(&self) -> bool {
        self.kind == "phrase"
    }

    fn is_for(&self, path: &str) -> bool {
        let allowed = self.allowed.iter().any(|start| path.starts_with(start));
        !allowed && (self.kind != "wgsl" || path.ends_with(".wgsl"))
    }
}

/// The words of a list, prepared for the search.
struct RetiredWords {
    /// Names, which are looked up: much faster than an expression for each.
    identifiers: HashMap<String, Word>,
    others: Vec<(Word, Regex)>,
    set: RegexSet,
    old_name: Regex,
}

impl RetiredWords {
    fn parse(list: &str) -> Result<Self, String> {
        let mut identifiers = HashMap::new();
        let mut others = Vec::new();
        let mut expressions = Vec::new();
        for line in list.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let word = Word::parse(line)?;
            if word.kind == "identifier" {
                identifiers.insert(word.pattern.clone(), word);
            } else {
                // Word boundaries are those of ASCII: others are slow.
                let expression = format!("(?m-u){}", word.expression().unwrap_or_default());
                let regex = Regex::new(&expression).map_err(|error| format!("{line}: {error}"))?;
                expressions.push(expression);
                others.push((word, regex));
            }
        }
        let set = RegexSetBuilder::new(&expressions).build().map_err(|error| error.to_string())?;
        let old_name =
            Regex::new(r#"(?-u)\b(alias|rename) = "[^"\n]*""#).map_err(|error| error.to_string())?;
        Ok(Self { identifiers, others, set, old_name })
    }

    /// Returns a line for each occurrence in a file: where it is, the word and what to say instead.
    fn find(&self, path: &str, text: &str) -> Vec<String> {
        let text = self.old_name.replace_all(text.as_bytes(), &b""[..]);
        // Phrases are also found in names, whose words are joined by underscores.
        let spaced: Vec<u8> = text.iter().map(|&byte| if byte == b'_' { b' ' } else { byte }).collect();
        let [plain, phrases] = [&text[..], &spaced].map(|text| self.set.matches(text));
        let others = self.others.iter().enumerate().filter(|(index, (word, _))| {
            if word.is_phrase() { phrases.matched(*index) } else { plain.matched(*index) }
        });
        let others: Vec<_> = others.map(|(_, other)| other).collect();
        let mut found = Vec::new();
        let lines = text.split(|byte| *byte == b'\n').zip(spaced.split(|byte| *byte == b'\n'));
        for (number, (line, spaced)) in lines.enumerate() {
            let names = line.split(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_');
            let names = names.filter_map(|name| self.identifiers.get(std::str::from_utf8(name).ok()?));
            let others = others
                .iter()
                .filter(|(word, regex)| regex.is_match(if word.is_phrase() { spaced } else { line }))
                .map(|(word, _)| word);
            for word in names.chain(others).filter(|word| word.is_for(path)) {
                let Word { kind, pattern, instead, .. } = word;
                let line = String::from_utf8_lossy(line);
                found.push(format!(
                    "{path}:{}: {kind} `{pattern}`, say instead: {instead}\n    {}",
                    number + 1,
                    line.trim()
                ));
            }
        }
        found
    }
}

/// Returns the files of the repository that are searched, but for build outputs and hidden ones.
fn files() -> Vec<PathBuf> {
    fn collect(dir: &Path, found: &mut Vec<PathBuf>) {
        for path in std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
            if path.is_dir() {
                if !name.starts_with('.') && !["target", "out"].contains(&name) {
                    collect(&path, found);
                }
            } else if EXTENSIONS.contains(&extension) && !EXCEPT.contains(&name) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    collect(&repository(), &mut found);
    found.sort();
    found
}

#[test]
fn no_retired_word_is_left() {
    let list = std::fs::read_to_string(repository().join(LIST)).unwrap();
    let words = RetiredWords::parse(&list).unwrap();
    let files = files();
    assert!(files.len() > 500, "{} files", files.len());
    let mut found = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let path = file.strip_prefix(repository()).unwrap().to_string_lossy().replace('\\', "/");
        found.extend(words.find(&path, &text));
    }
    assert!(found.is_empty(), "{} retired words (see {LIST}):\n{}", found.len(), found.join("\n"));
}

#[test]
fn retired_words_are_found_where_they_are_not_allowed() {
    let list = "# A comment.\n\
        identifier\tOldName\tNewName\n\
        type\tWidget\tControl\ttests/: what the tests draw\n\
        function\tspin\trotate\n\
        wgsl\tlet lit\\b\tvisibility\n\
        phrase\tin a (ring|loop)\tcycle\n";
    let words = RetiredWords::parse(list).unwrap();
    let count = |path: &str, text: &str| words.find(path, text).len();
    assert_eq!(
        words.find("src/a.rs", "\n  use OldName;\n"),
        ["src/a.rs:2: identifier `OldName`, say instead: NewName\n    use OldName;"]
    );
    for (path, text, expected) in [
        ("a.rs", "OldName, OldNames, old_name, oldname", 1),
        ("a.rs", "`OldName`\nOldName", 2),
        ("a.rs", "#[serde(alias = \"OldName\")]", 0),
        ("a.rs", "pub struct Widget;", 1),
        ("a.rs", "a Widget of a kind, struct Widgets", 0),
        ("tests/a.rs", "pub struct Widget;", 0),
        ("a.rs", "fn spin() { spin() }", 1),
        ("a.rs", "let lit = 1;", 0),
        ("a.wgsl", "let lit = 1;", 1),
        ("a.md", "they wait In a Ring; in a\nloop", 1),
        ("a.rs", "fn they_wait_in_a_ring() {}", 1),
        ("a.md", "", 0),
    ] {
        assert_eq!(count(path, text), expected, "{path}: {text}");
    }
}

#[test]
fn lines_of_the_list_that_are_wrong_are_errors() {
    for (line, expected) in [
        ("identifier\tA", "fewer than three columns"),
        ("noun\tA\tB", "unknown kind"),
        ("phrase\tA\tB\tcrates/core", "no reason"),
        ("phrase\tA\tB\tcrates/core: why\tmore", "more than four columns"),
        ("phrase\t(\tB", "unclosed group"),
    ] {
        let error = RetiredWords::parse(line).err().unwrap();
        assert!(error.contains(expected), "{line}: {error}");
    }
}
