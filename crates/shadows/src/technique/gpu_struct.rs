//! Structs that Rust writes and WGSL reads.

use shadowgraph_shaders::{Error, layout, naga};

/// The memory layout of a Rust struct, to be compared with the struct of that name in a technique's WGSL. Created by
/// [`gpu_struct!`](crate::gpu_struct).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpuStruct {
    /// The struct's name in WGSL.
    pub name: &'static str,
    /// Size, bytes.
    pub size: usize,
    /// The fields and their offsets, bytes.
    pub fields: Vec<(&'static str, usize)>,
}

impl GpuStruct {
    /// Compares the layout with the struct in the module.
    pub(crate) fn check(&self, module: &naga::Module) -> Result<(), Error> {
        layout::check(module, self.name, self.size, &self.fields)
    }
}

/// Describes the layout of a struct by its fields: all those that the WGSL struct has.
///
/// ```
/// #[repr(C)]
/// struct Haze {
///     density: f32,
///     height_m: f32,
/// }
/// let layout = shadowgraph_shadows::gpu_struct!(Haze { density, height_m });
/// assert_eq!((layout.name, layout.size, layout.fields[1]), ("Haze", 8, ("height_m", 4)));
/// ```
#[macro_export]
macro_rules! gpu_struct {
    ($name:ident { $($field:ident),+ $(,)? }) => {
        $crate::GpuStruct {
            name: stringify!($name),
            size: ::std::mem::size_of::<$name>(),
            fields: ::std::vec![$((stringify!($field), ::std::mem::offset_of!($name, $field))),+],
        }
    };
}
