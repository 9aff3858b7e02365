//! Validation of a technique's output against its declarations.

use shadowgraph_core::{Frame, Texture, TextureDesc};

use super::mask_layers::{MASK_FORMAT, MaskLayers};
use super::{ShadowBinding, ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use crate::error::Error;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;

/// Adds the passes of a technique to the frame, and validates its output. `buffers` must be `Some` for techniques that
/// [read them](ShadowTechnique::reads_surface_buffers).
///
/// # Errors
/// As [`ShadowTechnique::requirements`] and [`ShadowTechnique::add_to`]; [`Error::Technique`] for bindings that differ from
/// the declared ones, or a mask of the wrong shape.
pub fn add_shadows<'f>(
    technique: &'f dyn ShadowTechnique,
    frame: &mut Frame<'f>,
    inputs: &ShadowInputs<'f>,
    buffers: Option<&SurfaceBuffers>,
) -> Result<ShadowOutputs<'f>, Error> {
    let requirements = technique.requirements(inputs)?;
    add_checked(technique, frame, inputs, &requirements, buffers)
}

/// Adds the passes of a technique whose requirements are known, and validates its output.
pub(crate) fn add_checked<'f>(
    technique: &'f dyn ShadowTechnique,
    frame: &mut Frame<'f>,
    inputs: &ShadowInputs<'f>,
    requirements: &Requirements,
    buffers: Option<&SurfaceBuffers>,
) -> Result<ShadowOutputs<'f>, Error> {
    let outputs = technique.add_to(frame, inputs, requirements, buffers)?;
    let failed = |reason: String| Error::Technique { technique: technique.name().to_owned(), reason };
    check_bindings(frame, &outputs.bindings, &technique.binding_types()).map_err(failed)?;
    if let Some(mask) = &outputs.mask {
        let layers = MaskLayers::new(inputs.lights, &outputs.colored_lights);
        check_mask(frame, mask, &layers, buffers).map_err(failed)?;
    }
    let (variant, count) = (outputs.variant, technique.variant_count());
    if variant >= count {
        return Err(failed(format!("`add_to` returned variant {variant}, but `variant_count` is {count}")));
    }
    Ok(outputs)
}

fn check_bindings(
    frame: &Frame<'_>,
    bindings: &[ShadowBinding<'_>],
    types: &[wgpu::BindingType],
) -> Result<(), String> {
    if bindings.len() != types.len() {
        let (actual, declared) = (bindings.len(), types.len());
        return Err(format!("`add_to` returned {actual} bindings, but `binding_types` has {declared}"));
    }
    let mut pairs = bindings.iter().zip(types).enumerate();
    let wrong = pairs.find_map(|(number, (binding, ty))| {
        let actual = actual(frame, binding);
        (!actual.matches(ty)).then(|| {
            let actual = actual.describe();
            format!("`add_to` returned {actual} as binding {number}, but `binding_types` has {ty:?}")
        })
    });
    wrong.map_or(Ok(()), Err)
}

/// The properties of a binding that can be compared with the declared type.
enum Actual {
    Storage,
    Uniform,
    Sampler,
    Texture(Option<TextureDesc>, wgpu::TextureViewDimension),
}

fn actual(frame: &Frame<'_>, binding: &ShadowBinding<'_>) -> Actual {
    use wgpu::TextureViewDimension::{D2, D2Array};
    match binding {
        ShadowBinding::Buffer(_) | ShadowBinding::ExternalBuffer(_) => Actual::Storage,
        ShadowBinding::Uniform(_) | ShadowBinding::UniformBuffer(_) => Actual::Uniform,
        ShadowBinding::Sampler(_) => Actual::Sampler,
        ShadowBinding::Texture(texture) => Actual::Texture(frame.texture_desc(texture), D2),
        ShadowBinding::TextureArray(texture) => Actual::Texture(frame.texture_desc(texture), D2Array),
    }
}

impl Actual {
    fn matches(&self, ty: &wgpu::BindingType) -> bool {
        use wgpu::{BindingType, BufferBindingType, TextureSampleType};
        match (self, ty) {
            (Self::Storage, BindingType::Buffer { ty: BufferBindingType::Storage { read_only }, .. }) => {
                *read_only
            }
            (Self::Uniform, BindingType::Buffer { ty: BufferBindingType::Uniform, .. })
            | (Self::Sampler, BindingType::Sampler(_)) => true,
            (
                Self::Texture(desc, dimension),
                BindingType::Texture { sample_type, view_dimension, multisampled },
            ) => {
                let format_type = desc.and_then(|desc| desc.format.sample_type(None, None));
                let sampled = match (format_type, sample_type) {
                    // Every float texture can be read without a filter.
                    (
                        Some(TextureSampleType::Float { .. }),
                        TextureSampleType::Float { filterable: false },
                    ) => true,
                    (Some(format_type), declared) => format_type == *declared,
                    (None, _) => true,
                };
                sampled
                    && dimension == view_dimension
                    && desc.is_none_or(|desc| (desc.samples > 1) == *multisampled)
            }
            _ => false,
        }
    }

    fn describe(&self) -> String {
        match self {
            Self::Storage => "a storage buffer".into(),
            Self::Uniform => "a uniform block".into(),
            Self::Sampler => "a sampler".into(),
            Self::Texture(desc, dimension) => match desc {
                Some(desc) => format!("a texture {:?} as {dimension:?}", desc.format),
                None => format!("a texture as {dimension:?}"),
            },
        }
    }
}

fn check_mask(
    frame: &Frame<'_>,
    mask: &Texture,
    layers: &MaskLayers,
    buffers: Option<&SurfaceBuffers>,
) -> Result<(), String> {
    let (Some(buffers), Some(desc)) = (buffers, frame.texture_desc(mask)) else {
        return Err("`add_to` returned a screen mask without surface buffers".into());
    };
    let [width, height] = buffers.size_px;
    let expected = TextureDesc::d2(width, height, MASK_FORMAT).layers(layers.count());
    if desc == expected {
        return Ok(());
    }
    let shape = |desc: TextureDesc| {
        let size = desc.size;
        format!("{}x{} {:?} with {} layers", size.width, size.height, desc.format, size.depth_or_array_layers)
    };
    Err(format!("the screen mask is {}; expected {}", shape(desc), shape(expected)))
}
