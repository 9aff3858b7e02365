//! Draws the images of the documents by the list in `xtask/images.txt`.

use crate::child::{self, RuntimeDir};
use crate::recipes::{self, Panel, Recipe};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The directory for panels, settings and reports, in the repository.
const WORK: &str = "out/images";

const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// The scale of a page's screenshot.
const PAGE_SCALE: f64 = 0.8;

/// Builds what makes images. Naming the whole workspace gives dependencies the features that they have in the tests.
const BUILD: [&str; 6] = ["build", "--workspace", "--exclude", "xtask", "--bins", "--examples"];

/// The reason why a panel was not made.
enum Failure {
    /// What the machine lacks.
    Missing(String),
    Failed(String),
}

impl From<String> for Failure {
    fn from(error: String) -> Self {
        Self::Failed(error)
    }
}

/// Draws all images; returns a line for each that was left as it is, because something is missing on the machine.
///
/// # Errors
/// One line: the first command that failed.
pub(crate) fn draw() -> Result<Vec<String>, String> {
    let root = child::root();
    let list = root.join("xtask/images.txt");
    let list = std::fs::read_to_string(&list).map_err(|error| format!("{}: {error}", list.display()))?;
    let recipes = recipes::parse(&list)?;
    let work = root.join(WORK);
    // Files of an earlier run must not pass for those of this run.
    let _absent = std::fs::remove_dir_all(&work);
    std::fs::create_dir_all(&work).map_err(|error| format!("{}: {error}", work.display()))?;
    let studio = Studio { root, work, runtime: RuntimeDir::new(), built: built()? };
    studio.start(&mut child::cargo(&BUILD))?;
    studio.run_tests(&recipes)?;
    let mut left = Vec::new();
    for recipe in &recipes {
        println!("docs/images/{}.png", recipe.name);
        match studio.draw(recipe) {
            Ok(()) => (),
            Err(Failure::Missing(what)) => {
                left.push(format!("docs/images/{}.png: left as it is: {what}", recipe.name))
            }
            Err(Failure::Failed(error)) => return Err(format!("docs/images/{}.png: {error}", recipe.name)),
        }
    }
    Ok(left)
}

/// Returns the directory into which cargo builds programs: that of this one.
fn built() -> Result<PathBuf, String> {
    let here =
        std::env::current_exe().map_err(|error| format!("cannot find the path of this program: {error}"))?;
    Ok(here.parent().unwrap_or(Path::new(".")).to_path_buf())
}

struct Studio {
    root: PathBuf,
    work: PathBuf,
    runtime: RuntimeDir,
    built: PathBuf,
}

impl Studio {
    fn start(&self, command: &mut Command) -> Result<(), String> {
        let line = |command: &Command| {
            let words = std::iter::once(command.get_program()).chain(command.get_args());
            words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
        };
        let status = child::stream(self.runtime.apply(command))?;
        if status.success() { Ok(()) } else { Err(format!("`{}` failed ({status})", line(command))) }
    }

    /// Returns a command of a built program in the repository's root.
    fn built(&self, name: &str) -> Command {
        child::command(self.built.join(format!("{name}{}", std::env::consts::EXE_SUFFIX)))
    }

    /// Runs the tests that write panels.
    fn run_tests(&self, recipes: &[Recipe]) -> Result<(), String> {
        let panels = recipes.iter().flat_map(|recipe| &recipe.panels);
        let names: BTreeSet<&str> = panels
            .filter(|panel| panel.maker == "test")
            .flat_map(|panel| &panel.arguments)
            .map(String::as_str)
            .collect();
        if names.is_empty() {
            return Ok(());
        }
        let mut command =
            child::cargo(&["test", "--workspace", "--test", "pixels", "--test", "programs", "--"]);
        self.start(command.args(names).env("SHADOWGRAPH_IMAGES", &self.work))
    }

    fn draw(&self, recipe: &Recipe) -> Result<(), Failure> {
        let made = recipe.panels.iter().enumerate().map(|(index, panel)| {
            let name = format!("{}-{index}", recipe.name.replace('/', "-"));
            self.panel(panel, &self.work.join(name))
        });
        let made = made.collect::<Result<Vec<PathBuf>, Failure>>()?;
        let image = self.root.join("docs/images").join(&recipe.name).with_extension("png");
        if let ([panel], []) = (made.as_slice(), recipe.options.as_slice()) {
            return Ok(copy(panel, &image)?);
        }
        Ok(self.start(self.built("join_images").arg(&image).args(&recipe.options).arg("--").args(&made))?)
    }

    /// Makes a panel; `name` is the path of its files without the ending.
    fn panel(&self, panel: &Panel, name: &Path) -> Result<PathBuf, Failure> {
        let image = name.with_extension("png");
        let arguments = arguments(panel)?;
        let file = panel.file.as_deref().unwrap_or_default();
        match panel.maker.as_str() {
            "render" => {
                let mut command = self.built("shadowgraph");
                command.arg("render").args(arguments).args(settings(panel, name)?);
                self.start(command.arg("-o").arg(&image))?;
            }
            "measure" => {
                let mut command = self.built("shadowgraph");
                command.arg("measure").args(arguments).args(settings(panel, name)?);
                self.start(command.arg("-o").arg(name))?;
                copy(&name.join(file), &image)?;
            }
            "example" => {
                let mut example =
                    self.built(&format!("examples/{}", arguments.first().map_or("", String::as_str)));
                self.start(example.args(arguments.iter().skip(1)))?;
                // The next panel may be from a file of the same name.
                copy(&self.root.join(file), &image)?;
            }
            "test" => {
                let written = self.work.join(file);
                if !written.exists() {
                    return Err(Failure::Missing(format!("its test, which was skipped, wrote no {file}")));
                }
                copy(&written, &image)?;
            }
            "page" => self.page(&arguments, name)?,
            other => {
                return Err(format!(
                    "unknown maker `{other}`; expected one of: render, measure, page, example, test"
                )
                .into());
            }
        }
        Ok(image)
    }

    /// Makes a screenshot of the page about a frame. `arguments` are its size in pixels and the address in the page.
    fn page(&self, arguments: &[String], name: &Path) -> Result<(), Failure> {
        let [size, address] = arguments else {
            return Err("a page needs a size and an address".to_owned().into());
        };
        let browser = BROWSERS.into_iter().find(|name| child::on_path(name));
        let browser = browser.ok_or_else(|| Failure::Missing("Chromium is missing".into()))?;
        let sides: Vec<f64> = size.split('x').filter_map(|side| side.parse().ok()).collect();
        let [width, height] = sides[..] else { return Err(format!("`{size}` is not a size").into()) };
        let page = name.with_extension("html");
        self.start(self.built("shadowgraph").arg("dump").arg("-o").arg(&page))?;
        let mut command = child::command(browser);
        command.args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--virtual-time-budget=20000",
        ]);
        command.arg(format!("--user-data-dir={}", name.with_extension("browser").display()));
        command.arg(format!("--force-device-scale-factor={PAGE_SCALE}"));
        command.arg(format!("--window-size={},{}", width / PAGE_SCALE, height / PAGE_SCALE));
        command.arg(format!("--screenshot={}", name.with_extension("png").display()));
        command.arg(format!("file://{}#{address}", page.display()));
        Ok(self.start(command.stderr(std::process::Stdio::null()))?)
    }
}

/// Returns the arguments of a panel, with the directory of the shared test material in place of its variable.
fn arguments(panel: &Panel) -> Result<Vec<String>, Failure> {
    const VARIABLE: &str = "$SHADOWGRAPH_SHARED";
    let path = |argument: &String| {
        let Some(rest) = argument.strip_prefix(VARIABLE) else { return Ok(argument.clone()) };
        let base = std::env::var_os("SHADOWGRAPH_SHARED").ok_or("SHADOWGRAPH_SHARED is not set")?;
        Ok(format!("{}{rest}", base.to_string_lossy()))
    };
    panel
        .arguments
        .iter()
        .map(path)
        .collect::<Result<_, &str>>()
        .map_err(|what| Failure::Missing(what.into()))
}

/// Writes the settings of a panel; returns the option that names their file.
fn settings(panel: &Panel, name: &Path) -> Result<Vec<PathBuf>, String> {
    let Some(settings) = &panel.settings else { return Ok(Vec::new()) };
    let file = name.with_extension("ron");
    std::fs::write(&file, settings).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(vec!["--settings".into(), file])
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    std::fs::create_dir_all(to.parent().unwrap_or(Path::new(".")))
        .and_then(|()| std::fs::copy(from, to))
        .map(|_bytes| ())
        .map_err(|error| format!("cannot copy {} to {}: {error}", from.display(), to.display()))
}
