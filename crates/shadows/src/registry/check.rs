//! Checks of a technique without a GPU, as it is registered.

use shadowgraph_core::with_error_scopes;
use shadowgraph_shaders::{compose, naga};

use super::{TechniqueContext, TechniqueKind};
use crate::technique::binding::{STORAGE, UNIFORM};
use crate::technique::{ShadowTechnique, layout, shadow_layout};
use crate::techniques::compute::{pipeline, shader};

/// Checks a name, and that it is not taken.
pub(super) fn name(name: &str, mut known: impl Iterator<Item = &'static str>) -> Result<(), String> {
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.is_empty() || !name.chars().all(fits) {
        return Err("a name must be of lower-case letters, digits and `_`".into());
    }
    if known.any(|known| known == name) {
        return Err("the name is taken by another technique".into());
    }
    Ok(())
}

/// Creates the technique on wgpu's noop device, and checks everything that does not need a frame.
pub(super) fn kind(kind: &TechniqueKind) -> Result<(), String> {
    let Some(device) = noop_device() else { return Ok(()) };
    let technique = caught(&device, || kind.make(&TechniqueContext::new(&device)))?.map_err(one_line)?;
    if technique.name() != kind.name {
        return Err(format!("it creates a technique named `{}`", technique.name()));
    }
    if let Some(settings) = kind.settings {
        if settings.name != kind.name {
            return Err(format!("its settings are named `{}`", settings.name));
        }
        (settings.check_defaults)().map_err(|error| format!("default settings: {error}"))?;
    }
    limits(&technique.binding_types())?;
    if technique.variant_count() == 0 {
        return Err("`variant_count` must be at least 1".into());
    }
    (0..technique.variant_count()).try_for_each(|variant| {
        let module = compose("check.wgsl", &technique.modules(variant)).map_err(one_line)?;
        // Structs may be left out of variants that do not read them.
        if variant == 0 {
            technique
                .gpu_structs()
                .iter()
                .try_for_each(|described| described.check(&module))
                .map_err(one_line)?;
        }
        check_bindings(&device, technique.as_ref(), "cs_check", module)
    })?;
    explanation(&device, technique.as_ref())
}

/// Returns wgpu's noop device; `None` in browsers, which have none.
fn noop_device() -> Option<wgpu::Device> {
    #[cfg(not(target_arch = "wasm32"))]
    let device = Some(wgpu::Device::noop(&wgpu::DeviceDescriptor::default()).0);
    #[cfg(target_arch = "wasm32")]
    let device = None;
    device
}

/// Checks that the WGSL that explains points composes, and reads what `binding_types` declares.
fn explanation(device: &wgpu::Device, technique: &dyn ShadowTechnique) -> Result<(), String> {
    let Some(explanation) = technique.explanation() else { return Ok(()) };
    let modules = [technique.modules(0), explanation.modules].concat();
    let module = compose("check_explanation.wgsl", &modules).map_err(one_line)?;
    check_bindings(device, technique, "cs_check_explanation", module)
}

/// The bindings of a stage that a lit pass leaves to techniques within wgpu's default limits: it reads the lights, the uniform blocks of
/// the view, the sky and a material, and five textures and five samplers of materials. The mask of `+screen` takes a texture and a
/// uniform block more.
const AVAILABLE: [(&str, usize); 4] =
    [("storage buffers", 7), ("textures", 10), ("samplers", 11), ("uniform blocks", 8)];

pub(super) fn limits(types: &[wgpu::BindingType]) -> Result<(), String> {
    use wgpu::{BindingType, BufferBindingType};
    let mut counts = [0; 4];
    for (number, ty) in types.iter().enumerate() {
        let class = match ty {
            BindingType::Buffer { ty: BufferBindingType::Storage { read_only: true }, .. } => 0,
            BindingType::Texture { .. } => 1,
            BindingType::Sampler(_) => 2,
            BindingType::Buffer { ty: BufferBindingType::Uniform, .. } => 3,
            other => return Err(format!("binding {number} is {other:?}; lit passes can only read")),
        };
        counts[class] += 1;
    }
    let exceeded = counts.into_iter().zip(AVAILABLE).find(|(count, (_, available))| count > available);
    exceeded.map_or(Ok(()), |(count, (what, available))| {
        Err(format!("it has {count} bindings for {what}; wgpu's default limits leave {available} to group 1"))
    })
}

/// Checks that the WGSL reads of group 1 what `binding_types` declares: wgpu compares them when a pipeline is created.
fn check_bindings(
    device: &wgpu::Device,
    technique: &dyn ShadowTechnique,
    entry: &str,
    module: naga::Module,
) -> Result<(), String> {
    caught(device, || {
        let shader = shader(device, "check", module);
        let layouts = [&layout(device, "view", &[UNIFORM, STORAGE]), &shadow_layout(device, technique)];
        pipeline(device, &shader, entry, &layouts);
    })
}

/// Runs `work` and returns the device's validation error, which would end the program otherwise.
fn caught<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, String> {
    match with_error_scopes(device, &[wgpu::ErrorFilter::Validation], work) {
        (done, None) => Ok(done),
        (_, Some(error)) => Err(one_line(error)),
    }
}

fn one_line(error: impl std::fmt::Display) -> String {
    let text = error.to_string();
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.collect::<Vec<_>>().join("; ")
}
