//! The plan as one HTML page that needs nothing beside it.

mod data;
mod snapshot;

pub use snapshot::{Drawing, Outline, SnapshotTile, TexelValues, Texels, TextureSnapshot};

use crate::plan::Plan;
use crate::times::PassTime;
use data::FrameData;
use serde::Serialize;

const PAGE: &str = include_str!("html/page/page.html");
const STYLE: &str = include_str!("html/page/page.css");
/// In order: each file uses what is before it.
const SCRIPT: &[&str] = &[
    include_str!("html/page/frame.js"),
    include_str!("html/page/dom.js"),
    include_str!("html/page/layout.js"),
    include_str!("html/page/graph.js"),
    include_str!("html/page/timeline.js"),
    include_str!("html/page/memory.js"),
    include_str!("html/page/passes.js"),
    include_str!("html/page/pictures.js"),
    include_str!("html/page/log.js"),
    include_str!("html/page/details.js"),
    include_str!("html/page/main.js"),
];

impl Plan {
    /// Returns the plan as one HTML page, which opens anywhere: no network, no files beside it. It shows the graph, closed by
    /// node until asked; when each resource is in use; which resources take turns in memory; every pass; and every decision
    /// with its reason. [`HtmlPage`] adds times and pictures.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    /// frame.export_texture(&scene);
    /// let page = frame.compile()?.plan().to_html();
    /// assert!(page.starts_with("<!doctype html>") && page.contains("draw"));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn to_html(&self) -> String {
        HtmlPage::new(self).to_html()
    }
}

/// What a page about a frame holds beside its plan.
///
/// ```
/// use shadowgraph_core::{Frame, HtmlPage, PageTable};
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
    /// Sentences to be read first, such as on what the frame was drawn.
    pub notes: Vec<String>,
    /// Tables, each with a view of its own.
    pub tables: Vec<PageTable>,
    /// Plots of named outlines.
    pub drawings: Vec<Drawing>,
    /// What textures held.
    pub snapshots: Vec<TextureSnapshot>,
}

/// A table with a view of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PageTable {
    /// What the view is called.
    pub title: String,
    /// The heads of the columns.
    pub columns: Vec<String>,
    /// The cells, as many in each row as there are columns.
    pub rows: Vec<Vec<String>>,
}

impl<'p> HtmlPage<'p> {
    /// Begins a page about a frame.
    pub fn new(plan: &'p Plan) -> Self {
        let (notes, tables, drawings, snapshots) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { plan, title: "Frame".into(), times: &[], notes, tables, drawings, snapshots }
    }

    /// Names the page.
    #[must_use]
    pub fn with_title(self, title: &str) -> Self {
        Self { title: title.into(), ..self }
    }

    /// Adds the times of passes, in order of recording, as [`Timer::read`](crate::Timer::read) returns them.
    #[must_use]
    pub fn with_times(self, times: &'p [PassTime]) -> Self {
        Self { times, ..self }
    }

    /// Returns the page. Same frame, same bytes.
    pub fn to_html(&self) -> String {
        // A page holds no value that JSON cannot.
        let frame = serde_json::to_string(&FrameData::of(self)).unwrap_or_default();
        // Nothing in it may end the element that it stands in.
        let frame = frame.replace('<', "\\u003c");
        let title = escape(&self.title);
        let parts = [
            ("{{title}}", &*title),
            ("{{style}}", STYLE),
            ("{{frame}}", &frame),
            ("{{script}}", &SCRIPT.concat()),
        ];
        fill(PAGE, &parts)
    }
}

/// The text as it stands in HTML, in an element or in quotes.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Puts each part in the place of its name, once, whatever the other parts hold.
fn fill(template: &str, parts: &[(&str, &str)]) -> String {
    let mut out =
        String::with_capacity(template.len() + parts.iter().map(|(_, text)| text.len()).sum::<usize>());
    let mut rest = template;
    let next = |rest: &str| {
        parts
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
