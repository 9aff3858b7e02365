//! Helpers of the examples: a device, and PNG files.

use shadowgraph_core::wgpu;
use std::error::Error;
use std::fs::File;
use std::path::Path;

/// Opens the first available adapter.
pub(crate) fn open() -> Result<(wgpu::Device, wgpu::Queue), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    Ok(pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?)
}

/// Writes `out/NAME.png` from rows of red, green, blue, alpha, a byte each.
pub(crate) fn save(name: &str, width: u32, height: u32, rgba: &[u8]) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all("out")?;
    let path = Path::new("out").join(name).with_extension("png");
    let mut encoder = png::Encoder::new(File::create(&path)?, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(rgba)?;
    println!("wrote {}", path.display());
    Ok(())
}
