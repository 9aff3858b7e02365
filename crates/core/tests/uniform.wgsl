// Writes what the uniform block holds into a buffer, for a test that reads it back.
@group(0) @binding(0) var<uniform> block: vec4<u32>;
@group(0) @binding(1) var<storage, read_write> seen: vec4<u32>;

@compute @workgroup_size(1)
fn main() {
    seen = block;
}
