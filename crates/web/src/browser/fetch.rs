//! Files of the web, with progress.

use js_sys::{Reflect, Uint8Array};
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{ReadableStreamDefaultReader, Response};

use super::reason;
use crate::error::Error;

/// Fetches a file. `progress` gets the number of bytes so far, and that of the file, 0 if the server does not tell.
pub(super) async fn fetch(url: &str, progress: &mut dyn FnMut(u64, u64)) -> Result<Vec<u8>, Error> {
    let failed = |reason: String| Error::Fetch { url: url.into(), reason };
    let refused = |error: JsValue| failed(reason(&error));
    let window = web_sys::window().ok_or_else(|| failed("there is no window".into()))?;
    // Browsers tell pages no more than that it failed.
    let unreachable = |error: JsValue| {
        let why = "the server cannot be reached, or does not allow other pages to read the file (CORS)";
        failed(format!("{}: {why}", reason(&error)))
    };
    let response = JsFuture::from(window.fetch_with_str(url)).await.map_err(unreachable)?;
    let response: Response = response.dyn_into().map_err(refused)?;
    if !response.ok() {
        return Err(failed(format!("the server answers {} {}", response.status(), response.status_text())));
    }
    let length = response.headers().get("content-length").ok().flatten();
    let total = length.and_then(|length| length.parse().ok()).unwrap_or(0);
    let mut bytes = Vec::new();
    let Some(body) = response.body() else { return Ok(bytes) };
    let reader: ReadableStreamDefaultReader =
        body.get_reader().dyn_into().map_err(|error| refused(error.into()))?;
    loop {
        progress(bytes.len() as u64, total);
        let part = JsFuture::from(reader.read()).await.map_err(refused)?;
        let is_done = Reflect::get(&part, &"done".into()).map_err(refused)?.is_truthy();
        if is_done {
            return Ok(bytes);
        }
        let part: Uint8Array = Reflect::get(&part, &"value".into()).map_err(refused)?.unchecked_into();
        bytes.extend(part.to_vec());
    }
}
