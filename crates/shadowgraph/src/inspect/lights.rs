//! The table of a scene's lights.

use shadowgraph_core::{PassTime, Plan};
use shadowgraph_inspect::{HtmlPage, PageTable};
use shadowgraph_scene::{Light, LightKind};
use shadowgraph_shadows::Unshadowed;

use crate::rendered::RenderedFrame;

impl RenderedFrame {
    /// Returns the HTML page of the frame: its plan, times if they were measured, and the scene's lights.
    pub fn page(&self, lights: &[Light]) -> HtmlPage<'_> {
        page(&self.plan, &self.times, lights, &self.unshadowed)
    }
}

/// Returns the HTML page of a plan, with times and the scene's lights.
pub fn page<'p>(
    plan: &'p Plan,
    times: &'p [PassTime],
    lights: &[Light],
    unshadowed: &[Unshadowed],
) -> HtmlPage<'p> {
    let mut page = HtmlPage::new(plan).with_title("Shadowgraph frame").with_times(times);
    page.tables.push(table(lights, unshadowed));
    page
}

fn table(lights: &[Light], unshadowed: &[Unshadowed]) -> PageTable {
    let columns = ["Light", "Kind", "Name", "Intensity", "Shadows"].map(String::from).to_vec();
    let row = |(index, light): (usize, &Light)| {
        let intensity = format!("{:.1} {}", light.intensity, unit(light));
        let name = light.name.clone().unwrap_or_default();
        vec![index.to_string(), kind(light).into(), name, intensity, shadows(light, index, unshadowed)]
    };
    PageTable { title: "Lights".into(), columns, rows: lights.iter().enumerate().map(row).collect() }
}

/// Returns the kind of a light.
pub fn kind(light: &Light) -> &'static str {
    match light.kind {
        LightKind::Directional { .. } => "directional",
        LightKind::Spot { .. } => "spot",
        LightKind::Point { .. } => "point",
    }
}

/// Returns the unit of a light's intensity.
pub fn unit(light: &Light) -> &'static str {
    if matches!(light.kind, LightKind::Directional { .. }) { "lx" } else { "cd" }
}

/// Describes whether a light casts shadows, or why it does not.
pub fn shadows(light: &Light, index: usize, unshadowed: &[Unshadowed]) -> String {
    let missing = unshadowed.iter().find(|unshadowed| unshadowed.light as usize == index);
    match missing {
        _ if !light.casts_shadow => "no shadows requested".into(),
        Some(missing) => format!("no shadows: {}", missing.reason.describe()),
        None => "casts shadows".into(),
    }
}
