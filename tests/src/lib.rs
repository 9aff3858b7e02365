//! Shared by the tests of the whole workspace: paths, skips, the built program.

mod places;
mod program;
mod skip;
pub mod watch;

pub use places::{repository, shared};
pub use program::{ProgramError, on_path, program};
pub use skip::skip;
