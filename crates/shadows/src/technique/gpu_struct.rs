//! Structs that lie in memory as WGSL reads them.

use shadowgraph_shaders::{Error, layout, naga};

/// How a struct of Rust lies in memory, to be compared with the struct of that name in a technique's WGSL. Made by
/// [`gpu_struct!`](crate::gpu_struct).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpuStruct {
    /// The struct's name in WGSL.
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// The fields and where they are, bytes.
    pub fields: Vec<(&'static str, usize)>,
}

impl GpuStruct {
    /// Compares it with the module's struct.
    pub(crate) fn check(&self, module: &naga::Module) -> Result<(), Error> {
        layout::check(module, self.name, self.size, &self.fields)
    }
}

/// Describes a struct by its fields, all that WGSL has.
///
/// ```
/// #[repr(C)]
/// struct Haze {
///     density: f32,
///     height_m: f32,
/// }
/// let record = shadowgraph_shadows::gpu_struct!(Haze { density, height_m });
/// assert_eq!((record.name, record.size, record.fields[1]), ("Haze", 8, ("height_m", 4)));
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
