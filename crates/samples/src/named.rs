//! Scenes by their names.

use crate::city::{CITY_INSTANCES, city};
use crate::demo::demo_scene;
use crate::test_scenes::{TEST_SCENES, test_scene};
use shadowgraph_scene::Scene;

/// The seed of a city whose name has none.
const CITY_SEED: u64 = 1;

/// A name that no procedural scene has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnknownScene {
    /// No scene has this name.
    #[error("unknown scene `{name}`; expected one of: demo, {}, city:INSTANCES, city:INSTANCES:SEED", TEST_SCENES.join(", "))]
    Name {
        /// The given name.
        name: String,
    },
    /// The size of the city is not a number in the range, or its seed is not a number.
    #[error(
        "invalid city `{name}`; expected city:INSTANCES or city:INSTANCES:SEED with {} to {} instances and a seed of 0 to {}",
        CITY_INSTANCES.start(), CITY_INSTANCES.end(), u64::MAX
    )]
    City {
        /// The given name.
        name: String,
    },
}

/// Creates a procedural scene by its name: `demo`, one of [`TEST_SCENES`], or `city:INSTANCES`, as in `city:100000`, to which `:SEED`
/// can be added.
///
/// # Errors
/// An unknown name, or a city out of range.
///
/// ```
/// use shadowgraph_samples::named_scene;
/// assert_eq!(named_scene("city:12000:7")?.instances().len(), 12_000);
/// assert!(named_scene("castle").unwrap_err().to_string().starts_with("unknown scene `castle`; expected one of: demo, cube,"));
/// # Ok::<(), shadowgraph_samples::UnknownScene>(())
/// ```
pub fn named_scene(name: &str) -> Result<Scene, UnknownScene> {
    if name == "demo" {
        return Ok(demo_scene());
    }
    if let Some(size) = name.strip_prefix("city:") {
        return parse_city(size).ok_or_else(|| UnknownScene::City { name: name.to_owned() });
    }
    test_scene(name).ok_or_else(|| UnknownScene::Name { name: name.to_owned() })
}

fn parse_city(size: &str) -> Option<Scene> {
    match size.split_once(':') {
        Some((instances, seed)) => city(instances.parse().ok()?, seed.parse().ok()?),
        None => city(size.parse().ok()?, CITY_SEED),
    }
}
