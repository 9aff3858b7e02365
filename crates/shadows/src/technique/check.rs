//! What a technique gave is what it said it would.

use shadowgraph_core::{Frame, Texture, TextureDesc};
use shadowgraph_scene::Light;

use super::{ShadowBinding, ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use crate::techniques::MASK_FORMAT;
use crate::{Error, ShadowInputs, masked_lights};

/// Adds the passes of a technique to the frame, and checks what it gives. `screen` has to be there for techniques that
/// [read surfaces](ShadowTechnique::reads_surface_buffers).
///
/// # Errors
/// As [`ShadowTechnique::add_to`]; [`Error::Technique`] for bindings that are not what the technique said, or a mask of the
/// wrong shape.
pub fn add_shadows<'f>(
    technique: &'f dyn ShadowTechnique,
    frame: &mut Frame<'f>,
    inputs: &ShadowInputs<'f>,
    screen: Option<&SurfaceBuffers>,
) -> Result<ShadowOutputs<'f>, Error> {
    let outputs = technique.add_to(frame, inputs, screen)?;
    let failed = |reason: String| Error::Technique { technique: technique.name().to_owned(), reason };
    check_bindings(frame, &outputs.bindings, &technique.binding_types()).map_err(failed)?;
    if let Some(mask) = &outputs.mask {
        check_mask(frame, mask, inputs.lights, screen).map_err(failed)?;
    }
    if outputs.variant >= technique.variant_count() {
        let count = technique.variant_count();
        return Err(failed(format!("a frame asks for variant {}, and there are {count}", outputs.variant)));
    }
    Ok(outputs)
}

fn check_bindings(
    frame: &Frame<'_>,
    bindings: &[ShadowBinding<'_>],
    types: &[wgpu::BindingType],
) -> Result<(), String> {
    if bindings.len() != types.len() {
        let (given, said) = (bindings.len(), types.len());
        return Err(format!("a frame has {given} bindings, and `binding_types` says {said}"));
    }
    let mut pairs = bindings.iter().zip(types).enumerate();
    let wrong = pairs.find_map(|(number, (binding, ty))| {
        let given = given(frame, binding);
        (!given.fits(ty)).then(|| {
            format!("binding {number} of a frame is {}, and `binding_types` says {ty:?}", given.what())
        })
    });
    wrong.map_or(Ok(()), Err)
}

/// A binding of a frame, as far as it can be compared with what it was said to be.
enum Given {
    Storage,
    Uniform,
    Sampler,
    Texture(Option<TextureDesc>, wgpu::TextureViewDimension),
}

fn given(frame: &Frame<'_>, binding: &ShadowBinding<'_>) -> Given {
    use wgpu::TextureViewDimension::{D2, D2Array};
    match binding {
        ShadowBinding::Buffer(_) | ShadowBinding::ExternalBuffer(_) => Given::Storage,
        ShadowBinding::Uniform(_) => Given::Uniform,
        ShadowBinding::Sampler(_) => Given::Sampler,
        ShadowBinding::Texture(texture) => Given::Texture(frame.texture_desc(texture), D2),
        ShadowBinding::TextureArray(texture) => Given::Texture(frame.texture_desc(texture), D2Array),
    }
}

impl Given {
    fn fits(&self, ty: &wgpu::BindingType) -> bool {
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
                let of_format = desc.and_then(|desc| desc.format.sample_type(None, None));
                let sampled = match (of_format, sample_type) {
                    // Every texture of numbers can be read without a filter.
                    (
                        Some(TextureSampleType::Float { .. }),
                        TextureSampleType::Float { filterable: false },
                    ) => true,
                    (Some(of_format), wanted) => of_format == *wanted,
                    (None, _) => true,
                };
                sampled
                    && dimension == view_dimension
                    && desc.is_none_or(|desc| (desc.samples > 1) == *multisampled)
            }
            _ => false,
        }
    }

    fn what(&self) -> String {
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
    lights: &[Light],
    screen: Option<&SurfaceBuffers>,
) -> Result<(), String> {
    let (Some(screen), Some(desc)) = (screen, frame.texture_desc(mask)) else {
        return Err("it gives a mask without a picture to mask".into());
    };
    let [width, height] = screen.size_px;
    let wanted = TextureDesc::d2(width, height, MASK_FORMAT).layers(masked_lights(lights).len() as u32);
    if desc == wanted {
        return Ok(());
    }
    let shape = |desc: TextureDesc| {
        let size = desc.size;
        format!("{}x{} {:?} with {} layers", size.width, size.height, desc.format, size.depth_or_array_layers)
    };
    Err(format!("its screen mask is {}, and the picture's has to be {}", shape(desc), shape(wanted)))
}
