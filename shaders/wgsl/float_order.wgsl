// Floats as integers of the same order, for atomic minima and maxima.
#define_import_path shadowgraph::float_order

fn encoded(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    return select(bits | 0x80000000u, ~bits, (bits >> 31u) == 1u);
}

fn decoded(code: u32) -> f32 {
    return bitcast<f32>(select(~code, code & 0x7fffffffu, (code >> 31u) == 1u));
}
