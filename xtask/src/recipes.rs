//! The list of the images of the documents, `xtask/images.txt`.

/// An image of `docs/images` and how it is made.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Recipe {
    /// The path in `docs/images`, without the extension.
    pub(crate) name: String,
    /// Options of `join_images`.
    pub(crate) options: Vec<String>,
    pub(crate) panels: Vec<Panel>,
}

/// A panel of an image.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Panel {
    /// The first word, which says what makes the panel.
    pub(crate) maker: String,
    pub(crate) arguments: Vec<String>,
    /// The text of a settings file.
    pub(crate) settings: Option<String>,
    /// The file that the maker writes.
    pub(crate) file: Option<String>,
}

/// Reads the list; its format is described at its head.
///
/// # Errors
/// One line that names the line of the list.
pub(crate) fn parse(list: &str) -> Result<Vec<Recipe>, String> {
    let mut recipes: Vec<Recipe> = Vec::new();
    for (index, line) in list.lines().enumerate() {
        let text = line.trim();
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let error = |what: &str| format!("xtask/images.txt:{}: {what}", index + 1);
        if line.starts_with(' ') {
            let recipe = recipes.last_mut().ok_or_else(|| error("a panel before the first image"))?;
            recipe.panels.push(panel(text).ok_or_else(|| error("a quotation mark is missing"))?);
        } else {
            let mut words = text.split(' ').map(str::to_owned);
            let name = words.next().unwrap_or_default();
            recipes.push(Recipe { name, options: words.collect(), panels: Vec::new() });
        }
    }
    Ok(recipes)
}

fn panel(text: &str) -> Option<Panel> {
    let (text, file) = split(text, " -> ");
    let (text, settings) = split(text, " settings ");
    let mut words = words(text)?.into_iter();
    Some(Panel { maker: words.next()?, arguments: words.collect(), settings, file })
}

fn split<'a>(text: &'a str, mark: &str) -> (&'a str, Option<String>) {
    text.split_once(mark).map_or((text, None), |(text, rest)| (text, Some(rest.to_owned())))
}

/// Splits a command line into words; quotation marks join words. Returns `None` if one has no counterpart.
fn words(text: &str) -> Option<Vec<String>> {
    let parts: Vec<&str> = text.split('"').collect();
    let mut words = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        if index % 2 == 1 {
            words.push((*part).to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    (parts.len() % 2 == 1).then_some(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_have_panels_with_quoted_words_settings_and_files() {
        let list = "# about\nshadows/a columns=2\n    render --aov \"base color\" settings (x: \"y\")\n    test t -> t.png\n";
        let new_panel = |maker: &str, arguments: &[&str], settings: Option<&str>, file: Option<&str>| Panel {
            maker: maker.into(),
            arguments: arguments.iter().map(|word| (*word).into()).collect(),
            settings: settings.map(Into::into),
            file: file.map(Into::into),
        };
        let panels = vec![
            new_panel("render", &["--aov", "base color"], Some("(x: \"y\")"), None),
            new_panel("test", &["t"], None, Some("t.png")),
        ];
        let wanted = Recipe { name: "shadows/a".into(), options: vec!["columns=2".into()], panels };
        assert_eq!(parse(list), Ok(vec![wanted]));
    }

    #[test]
    fn errors_name_the_line() {
        assert_eq!(parse("    render"), Err("xtask/images.txt:1: a panel before the first image".into()));
        assert_eq!(parse("a\n  render \"b"), Err("xtask/images.txt:2: a quotation mark is missing".into()));
    }

    #[test]
    fn every_image_has_panels_of_a_known_maker() {
        let recipes = parse(include_str!("../images.txt")).unwrap_or_default();
        assert!(recipes.len() > 40);
        for recipe in recipes {
            assert!(!recipe.panels.is_empty(), "{}", recipe.name);
            for panel in &recipe.panels {
                let has_file = match panel.maker.as_str() {
                    "render" | "page" => false,
                    "measure" | "example" | "test" => true,
                    other => unreachable!("{}: {other}", recipe.name),
                };
                assert_eq!(panel.file.is_some(), has_file, "{}: {panel:?}", recipe.name);
            }
        }
    }
}
