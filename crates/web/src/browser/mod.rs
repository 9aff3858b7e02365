//! The parts that need a browser.

mod canvas;
mod fetch;
mod lacks;
mod model;
mod pixels;
mod viewer;

pub use canvas::Canvas;
pub use viewer::Viewer;

use wasm_bindgen::{JsError, JsValue};

/// Returns an error as an object of JavaScript, whose message is one line.
fn thrown(error: impl std::fmt::Display) -> JsValue {
    JsError::new(&error.to_string()).into()
}

/// Returns what the browser says about an error.
fn reason(error: &JsValue) -> String {
    let text = js_sys::Object::from(error.clone()).to_string();
    text.as_string().unwrap_or_else(|| "unknown error".into())
}
