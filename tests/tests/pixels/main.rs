//! Images that a GPU renders, compared with ground truth. One program whose tests share a few devices; images of at most 320x180.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod analytic;
mod animation;
mod aovs;
mod captured;
mod casters;
mod contact_sheet;
mod edits;
mod files;
mod first_look;
mod gpu_culling;
mod hostile;
mod lost;
mod maps;
mod measure;
mod noise;
mod page_depths;
mod pipelines;
mod pixel_history;
mod planted;
mod post;
mod raytraced;
mod rows;
mod scenes;
mod snapping;
mod soft;
mod stage;
mod techniques;
mod tints;
mod trails;
mod velocity;
mod virtual_maps;
