//! Why tiles were drawn or kept, as sentences.

use std::fmt::Write as _;

use super::contents::{Because, Held, Wanted, Work};
use crate::caster_view::TileKind;
use crate::casters::ShadowCasters;
use crate::plan::TilePlan;

/// Most names that a sentence lists.
const NAMES: usize = 2;

/// Returns the name of a tile.
pub(super) fn tile_name(tile: &TilePlan) -> String {
    match tile.kind {
        TileKind::Cascade(cascade) => format!("cascade {cascade}"),
        TileKind::Face(face) => format!("light {} face {face}", tile.light),
        TileKind::Whole => format!("light {}", tile.light),
    }
}

/// Says what is done for a tile, and why.
pub(super) fn reason(
    work: &Work,
    held: Option<&Held>,
    wanted: &Wanted,
    static_count: usize,
    casters: &dyn ShadowCasters,
) -> String {
    match work {
        Work::Nothing => format!("kept: {} unchanged", counted(static_count + wanted.moving.len(), "caster")),
        Work::All { because, .. } => {
            let because = match because {
                Because::New => "nothing is kept of it",
                Because::Refitted => "its light has moved or its range has changed",
                Because::Changed => "casters have changed, or others matter",
                Because::Hidden => "casters have changed, and tints depend on all that hide them",
                Because::Moving => "more casters move than stand still",
            };
            format!("drawn: {because}")
        }
        Work::OverStore(fill) => {
            let mut text = match (fill.is_all, fill.strips.len()) {
                (true, _) => format!("stored: {}", counted(static_count, "static caster")),
                (false, 0) => format!("kept: {} unchanged", counted(static_count, "static caster")),
                (false, strips) => {
                    let texels: u64 = fill.strips.iter().map(super::scroll::Texels::count).sum();
                    let strips = counted(strips, "strip");
                    format!("kept: all but {strips} of {texels} texels that came in")
                }
            };
            if !fill.added.is_empty() {
                let _ = write!(text, "; added: {}", names(&fill.added, casters));
            }
            let moved = moved(held, wanted);
            if !moved.is_empty() {
                let _ = write!(text, "; drawn: {} moved", names(&moved, casters));
            }
            text
        }
    }
}

/// Returns the moving casters that changed since the tile was drawn, or all if none did.
fn moved(held: Option<&Held>, wanted: &Wanted) -> Vec<u32> {
    let changed = |entry: &&(u32, Option<u64>)| {
        entry.1.is_none() || !held.is_some_and(|held| held.moving.contains(entry))
    };
    wanted.moving.iter().filter(changed).map(|(caster, _)| *caster).collect()
}

fn names(numbers: &[u32], casters: &dyn ShadowCasters) -> String {
    let name = |&caster: &u32| match casters.caster_name(caster) {
        Some(name) => format!("`{name}`"),
        None => format!("caster {caster}"),
    };
    let mut text: Vec<String> = numbers.iter().take(NAMES).map(name).collect();
    if numbers.len() > NAMES {
        text.push(format!("{} more", numbers.len() - NAMES));
    }
    match text.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => text.concat(),
    }
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
