//! Models of a page: from files that were dropped on it, and from the web.

use js_sys::{Array, Function, Uint8Array};
use shadowgraph::scene::gltf::{Progress, referenced_files};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::Url;

use super::fetch::fetch;
use super::thrown;
use crate::error::Error;
use crate::model::Model;

#[wasm_bindgen]
impl Model {
    /// Loads a glTF or GLB file from its bytes. `files` is an array of `[path, bytes]`, those that it refers to, by their paths relative to it.
    ///
    /// # Errors
    /// Of the file: where, and what is wrong there.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, bytes: &[u8], files: Option<Array>) -> Result<Self, JsValue> {
        let files = files.iter().flat_map(Array::iter).filter_map(|pair| {
            let pair: Array = pair.dyn_into().ok()?;
            Some((pair.get(0).as_string()?, pair.get(1).dyn_into::<Uint8Array>().ok()?.to_vec()))
        });
        let files: Vec<_> = files.collect();
        Self::from_bytes(name, bytes, &files, &mut |_: Progress| {}).map_err(thrown)
    }

    /// Returns the built-in demo scene.
    #[must_use]
    pub fn demo() -> Self {
        Self::demo_scene()
    }

    /// Fetches a glTF or GLB file, and those that it refers to. `progress` is called with the part of the current file that has arrived, 0 to 1,
    /// and its name.
    ///
    /// # Errors
    /// For a file that cannot be fetched, and as the constructor.
    pub async fn fetch(url: String, progress: Option<Function>) -> Result<Self, JsValue> {
        load(&url, progress.as_ref()).await.map_err(thrown)
    }

    /// Returns what is not drawn as the file says, and what was added to it, a line each.
    #[wasm_bindgen(js_name = notes)]
    #[must_use]
    pub fn copied_notes(&self) -> Vec<String> {
        self.notes().to_vec()
    }
}

async fn load(url: &str, progress: Option<&Function>) -> Result<Model, Error> {
    let name = url.split(['?', '#']).next().unwrap_or_default().rsplit('/').next().unwrap_or(url).to_owned();
    let report = |name: String| {
        move |bytes: u64, total: u64| {
            let part = if total == 0 { 0.0 } else { (bytes as f64 / total as f64).min(1.0) };
            if let Some(progress) = progress {
                // What a page does with it is not an error of the file.
                let _result = progress.call2(&JsValue::NULL, &part.into(), &JsValue::from_str(&name));
            }
        }
    };
    let bytes = fetch(url, &mut report(name.clone())).await?;
    let mut files = Vec::new();
    for path in referenced_files(&name, &bytes)? {
        let url = sibling_url(url, &path)?;
        let bytes = fetch(&url, &mut report(path.clone())).await?;
        files.push((path, bytes));
    }
    Model::from_bytes(&name, &bytes, &files, &mut |_| {})
}

/// Returns the address of a file by its path relative to another one.
fn sibling_url(url: &str, path: &str) -> Result<String, Error> {
    let failed = |error: JsValue| Error::Fetch { url: url.into(), reason: super::reason(&error) };
    let page = web_sys::window().and_then(|window| window.location().href().ok()).unwrap_or_default();
    let base = Url::new_with_base(url, &page).map_err(failed)?;
    let path: String = js_sys::encode_uri(path).into();
    // What `encodeURI` leaves has a meaning in addresses.
    let path = path.replace('?', "%3F").replace('#', "%23");
    Ok(Url::new_with_base(&format!("./{path}"), &base.href()).map_err(failed)?.href())
}
