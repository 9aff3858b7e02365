//! The plan as one self-contained HTML page.

mod data;
mod snapshot;

pub use snapshot::{Drawing, Outline};

use data::FrameData;
#[cfg(feature = "serve")]
use flate2::Compression;
use serde::Serialize;
use shadowgraph_core::{PassTime, Plan, TextureSnapshot};

const PAGE: &str = include_str!("html/page/page.html");
const STYLE: &str = include_str!("html/page/page.css");
/// The scripts in order: each file uses the ones before it.
const SCRIPT: &[&str] = &[
    include_str!("html/page/frame.js"),
    include_str!("html/page/dom.js"),
    include_str!("html/page/layout.js"),
    include_str!("html/page/graph.js"),
    include_str!("html/page/timeline.js"),
    include_str!("html/page/memory.js"),
    include_str!("html/page/passes.js"),
    include_str!("html/page/textures.js"),
    include_str!("html/page/log.js"),
    include_str!("html/page/live.js"),
    include_str!("html/page/details.js"),
    include_str!("html/page/main.js"),
];

/// Returns the plan as one self-contained HTML page. It shows the graph, grouped by node; when each resource is in use;
/// which resources share memory; every pass; and every decision with its reason. [`HtmlPage`] adds times and the contents of
/// textures.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
/// let mut frame = Frame::new();
/// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
/// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
/// frame.export_texture(&scene);
/// let page = shadowgraph_inspect::to_html(frame.compile()?.plan());
/// assert!(page.starts_with("<!doctype html>") && page.contains("draw"));
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
pub fn to_html(plan: &Plan) -> String {
    HtmlPage::new(plan).to_html()
}

/// An HTML page about a frame: its plan, and optionally times, notes, tables, plots and captured textures.
///
/// ```
/// use shadowgraph_core::Frame;
/// use shadowgraph_inspect::{HtmlPage, PageTable};
/// let compiled = Frame::new().compile()?;
/// let mut page = HtmlPage::new(compiled.plan()).with_title("An empty frame");
/// let (columns, rows) = (vec!["Name".into()], vec![vec!["hall.glb".into()]]);
/// page.tables.push(PageTable { title: "Files".into(), columns, rows });
/// assert!(page.to_html().contains("hall.glb"));
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
pub struct HtmlPage<'p> {
    plan: &'p Plan,
    title: String,
    times: &'p [PassTime],
    /// Notes that are shown first, such as the adapter that the frame was drawn on.
    pub notes: Vec<String>,
    /// Tables, a tab each.
    pub tables: Vec<PageTable>,
    /// Plots of named outlines.
    pub drawings: Vec<Drawing>,
    /// Captured contents of textures.
    pub snapshots: Vec<TextureSnapshot>,
    /// For the page of a running program.
    live: Option<LivePage>,
}

/// What the page of a running program knows besides the frame.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct LivePage {
    /// The number of the plan.
    pub(crate) plan: u32,
}

/// A table, shown in its own tab.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PageTable {
    /// Title of the tab.
    pub title: String,
    /// Column headers.
    pub columns: Vec<String>,
    /// Rows of cells, one cell for each column.
    pub rows: Vec<Vec<String>>,
}

impl<'p> HtmlPage<'p> {
    /// Creates a page about a frame.
    pub fn new(plan: &'p Plan) -> Self {
        let (notes, tables, drawings, snapshots) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { plan, title: "Frame".into(), times: &[], notes, tables, drawings, snapshots, live: None }
    }

    /// Sets the title of the page.
    #[must_use]
    pub fn with_title(self, title: &str) -> Self {
        Self { title: title.into(), ..self }
    }

    /// Adds the times of passes, in order of recording, as `Timer::read` returns them.
    #[must_use]
    pub fn with_times(self, times: &'p [PassTime]) -> Self {
        Self { times, ..self }
    }

    /// Makes it the page of a running program.
    #[cfg(feature = "serve")]
    pub(crate) fn with_live(self, live: LivePage) -> Self {
        Self { live: Some(live), ..self }
    }

    /// Returns the page. The same frame gives the same bytes.
    pub fn to_html(&self) -> String {
        // All values of a page can be written as JSON.
        let frame = serde_json::to_string(&FrameData::new(self)).unwrap_or_default();
        // The data must not end the element that contains it.
        let frame = frame.replace('<', "\\u003c");
        let title = escape(&self.title);
        let values = [
            ("{{title}}", &*title),
            ("{{style}}", STYLE),
            ("{{frame}}", &frame),
            ("{{script}}", &SCRIPT.concat()),
        ];
        fill(PAGE, &values)
    }
}

/// Returns the data of a snapshot for the script, as JSON. It is compressed in little time, as it is sent many times a second.
#[cfg(feature = "serve")]
pub(crate) fn snapshot_json(plan: &Plan, snapshot: &TextureSnapshot) -> String {
    serde_json::to_string(&snapshot::SnapshotData::new(plan, snapshot, Compression::fast()))
        .unwrap_or_default()
}

/// Escapes text for HTML, in an element or in quotes.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Replaces each placeholder by its text, once; texts are not searched for placeholders.
fn fill(template: &str, values: &[(&str, &str)]) -> String {
    let mut out =
        String::with_capacity(template.len() + values.iter().map(|(_, text)| text.len()).sum::<usize>());
    let mut rest = template;
    let next = |rest: &str| {
        values
            .iter()
            .filter_map(|(name, text)| Some((rest.find(name)?, *name, *text)))
            .min_by_key(|(at, ..)| *at)
    };
    while let Some((at, name, text)) = next(rest) {
        out.push_str(&rest[..at]);
        out.push_str(text);
        rest = &rest[at + name.len()..];
    }
    out + rest
}
