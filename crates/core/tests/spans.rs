//! Spans of `tracing`: the phases of compiling, and each pass by its path.
#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, reason = "tests")]

use shadowgraph_core::{Contents, Format, Graph, TextureDesc, wgpu};
use std::fmt::Debug;
use std::sync::{Arc, Mutex};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// Records the names of spans, and the value of their field `name`.
#[derive(Clone, Default)]
struct Notes(Arc<Mutex<Vec<String>>>);

struct Named(Option<String>);

impl Visit for Named {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "name" {
            self.0 = Some(format!("{value:?}"));
        }
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "name" {
            self.0 = Some(value.to_owned());
        }
    }
}

impl Subscriber for Notes {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target().starts_with("shadowgraph_core")
    }

    fn new_span(&self, span: &Attributes<'_>) -> Id {
        let mut named = Named(None);
        span.record(&mut named);
        let mut notes = self.0.lock().unwrap();
        notes.push(match named.0 {
            Some(name) => format!("{} {name}", span.metadata().name()),
            None => span.metadata().name().to_owned(),
        });
        Id::from_u64(notes.len() as u64)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn event(&self, _: &Event<'_>) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

#[test]
fn compiling_and_every_pass_body_have_spans() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let notes = Notes::default();
    tracing::subscriber::with_default(notes.clone(), || {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        frame.node("post", |frame| {
            let mut color = frame.create_texture("color", TextureDesc::d2(8, 8, Format::Rgba8Unorm));
            let mut pass = frame.render_pass("fade");
            pass.color(&mut color, Contents::clear_color([0.0; 4]));
            pass.body(|_| Ok(()));
            frame.export_texture(&color);
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        graph.compile(frame).unwrap().execute(&mut graph, &device, &mut encoder).unwrap();
        queue.submit([encoder.finish()]);
    });
    let phases = ["compile", "validate", "cull", "hazards", "order", "merge", "lifetime", "ops", "alias"];
    let expected: Vec<String> =
        phases.iter().map(|&phase| phase.to_owned()).chain(["pass post/fade".into()]).collect();
    assert_eq!(*notes.0.lock().unwrap(), expected);
}
