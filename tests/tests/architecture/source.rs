//! The paths that a source file of Rust names.

/// A path in a source file.
pub(crate) struct Mention {
    pub(crate) line: usize,
    pub(crate) path: Vec<String>,
    /// The name that the file gives it, if it is imported.
    pub(crate) name: Option<String>,
}

/// Names in a source file.
#[derive(Default)]
pub(crate) struct Source {
    pub(crate) mentions: Vec<Mention>,
    /// The macros that it declares.
    pub(crate) macros: Vec<String>,
    /// The modules that it declares for tests only.
    pub(crate) test_modules: Vec<String>,
}

impl Source {
    pub(crate) fn new(text: &str) -> Self {
        let mut source = Self::default();
        let tokens = tokens(text);
        let word = |i: usize| tokens.get(i).map_or("", |(_, token)| token.as_str());
        let mut i = 0;
        while i < tokens.len() {
            let starts = i == 0 || !matches!(word(i - 1), "::" | "$");
            if (0..7).map(|k| word(i + k)).eq(["#", "[", "cfg", "(", "test", ")", "]"]) {
                let end = item_end(&tokens, i + 7);
                let module = (i..end).find(|k| word(*k) == "mod").filter(|_| word(end - 1) == ";");
                source.test_modules.extend(module.map(|k| word(k + 1).to_owned()));
                i = end;
            } else if word(i) == "use" && word(i + 1) != "<" {
                i = source.use_tree(&tokens, i + 1, &[]);
            } else if word(i) == "macro_rules" {
                source.macros.push(word(i + 2).to_owned());
                i += 3;
            } else if starts && is_name(word(i)) && word(i + 1) == "::" {
                let line = tokens[i].0;
                let mut path = vec![word(i).to_owned()];
                while word(i + 1) == "::" && is_name(word(i + 2)) {
                    path.push(word(i + 2).to_owned());
                    i += 2;
                }
                source.mentions.push(Mention { line, path, name: None });
                i += 1;
            } else {
                i += 1;
            }
        }
        source
    }

    /// Reads the tree of a `use` from a token on, and returns the index of the token after it.
    fn use_tree(&mut self, tokens: &[(usize, String)], mut i: usize, parent: &[String]) -> usize {
        let mut path = parent.to_vec();
        let mut name = None;
        let line = tokens.get(i).map_or(0, |(line, _)| *line);
        while let Some((_, token)) = tokens.get(i) {
            match token.as_str() {
                "{" => {
                    while tokens[i].1 != "}" {
                        i = self.use_tree(tokens, i + 1, &path);
                    }
                    return i + 1;
                }
                "," | "}" | ";" => break,
                "::" | "*" => {}
                "self" if !path.is_empty() => {}
                "as" => {
                    i += 1;
                    name = Some(tokens[i].1.clone());
                }
                part => path.push(part.to_owned()),
            }
            i += 1;
        }
        if path.len() > parent.len() || tokens[i - 1].1 == "self" {
            let name = name.or_else(|| path.last().cloned());
            self.mentions.push(Mention { line, path, name });
        }
        i
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Returns the index of the token after the item that begins at one.
fn item_end(tokens: &[(usize, String)], start: usize) -> usize {
    let mut depth = 0;
    for (i, (_, token)) in tokens.iter().enumerate().skip(start) {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        if depth == 0 && matches!(token.as_str(), "}" | ";") {
            return i + 1;
        }
    }
    tokens.len()
}

/// Returns the names, the `::` and the single other characters of a source file with their lines, without comments and literals.
fn tokens(text: &str) -> Vec<(usize, String)> {
    let mut tokens = Vec::new();
    let (mut rest, mut line) = (text, 1);
    while let Some(c) = rest.chars().next() {
        let name = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let literal = literal_len(rest);
        let len = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if literal > 0 {
            literal
        } else {
            let len = if name > 0 {
                name
            } else if rest.starts_with("::") {
                2
            } else {
                c.len_utf8()
            };
            if !c.is_whitespace() {
                tokens.push((line, rest[..len].to_owned()));
            }
            len
        };
        line += rest[..len].matches('\n').count();
        rest = &rest[len..];
    }
    tokens
}

/// Returns the length of the string or the character that a text begins with; 0 if there is none.
fn literal_len(text: &str) -> usize {
    let after = text.trim_start_matches(['b', 'c']);
    let raw = after.strip_prefix('r').map(|raw| (raw, raw.len() - raw.trim_start_matches('#').len()));
    if let Some((raw, hashes)) = raw.filter(|(raw, hashes)| raw[*hashes..].starts_with('"')) {
        let end = format!("\"{}", "#".repeat(hashes));
        let body = &raw[hashes + 1..];
        let len = body.find(&end).map_or(body.len(), |at| at + end.len());
        return text.len() - body.len() + len;
    }
    let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''));
    let Some(quote) = quote.filter(|_| text.len() - after.len() < 2) else { return 0 };
    let mut escaped = false;
    for (at, c) in after.char_indices().skip(1) {
        // `'a` without a quote after it is a lifetime.
        if quote == '\'' && at > 1 && !after[1..].starts_with('\\') && c != '\'' {
            return 0;
        }
        if c == quote && !escaped {
            return text.len() - after.len() + at + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    0
}
