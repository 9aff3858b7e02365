//! Irradiance in spherical harmonics (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
//! 2001).

use std::f32::consts::{PI, TAU};

use glam::Vec3;

/// Number of rings of directions; each has twice as many directions.
const RINGS: usize = 32;

/// Returns directions of equal solid angle over the sphere, ring by ring.
fn directions() -> impl Iterator<Item = Vec3> {
    (0..RINGS).flat_map(|ring| {
        let y = 1.0 - (ring as f32 + 0.5) * 2.0 / RINGS as f32;
        let radius = (1.0 - y * y).sqrt();
        (0..2 * RINGS).map(move |step| {
            let (sin, cos) = ((step as f32 + 0.5) * TAU / (2 * RINGS) as f32).sin_cos();
            Vec3::new(radius * cos, y, radius * sin)
        })
    })
}

/// The solid angle of one of the directions, steradians.
const SOLID_ANGLE: f32 = 4.0 * PI / (RINGS * 2 * RINGS) as f32;

/// Returns the irradiance of a surface that faces up, given the radiance from the directions above it.
pub(super) fn irradiance_upwards(radiance: impl Fn(Vec3) -> Vec3) -> Vec3 {
    let above = directions().filter(|direction| direction.y > 0.0);
    above.map(|direction| radiance(direction) * (direction.y * SOLID_ANGLE)).sum()
}

/// Returns irradiance over π as the factors of 1, y, z, x, xy, yz, 3z² - 1, xz and x² - y² of the surface's normal.
pub(super) fn irradiance_over_pi(radiance: impl Fn(Vec3) -> Vec3) -> [Vec3; 9] {
    let mut sums = [Vec3::ZERO; 9];
    for direction in directions() {
        let radiance = radiance(direction) * SOLID_ANGLE;
        for (sum, value) in sums.iter_mut().zip(polynomials(direction)) {
            *sum += radiance * value;
        }
    }
    // Squares of the normalisation of each function, times the factors of the cosine lobe over π: 1, 2/3 and 1/4.
    let squares = [0.25, 0.75, 0.75, 0.75, 3.75, 3.75, 0.3125, 3.75, 0.9375].map(|square| square / PI);
    let lobes = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];
    std::array::from_fn(|i| sums[i] * (squares[i] * lobes[i]))
}

fn polynomials(d: Vec3) -> [f32; 9] {
    let Vec3 { x, y, z } = d;
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluate(factors: &[Vec3; 9], normal: Vec3) -> f32 {
        factors.iter().zip(polynomials(normal)).map(|(factor, value)| factor.x * value).sum()
    }

    #[test]
    fn a_uniform_environment_gives_its_radiance_everywhere() {
        let factors = irradiance_over_pi(|_| Vec3::splat(2.0));
        for normal in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, -0.8)] {
            assert!((evaluate(&factors, normal) - 2.0).abs() < 0.01);
        }
        assert!((irradiance_upwards(|_| Vec3::ONE).x - PI).abs() < 1e-2);
    }

    #[test]
    fn half_an_environment_gives_half_to_surfaces_that_see_half_of_it() {
        let factors = irradiance_over_pi(|direction| if direction.y > 0.0 { Vec3::ONE } else { Vec3::ZERO });
        for (normal, expected) in [(Vec3::Y, 1.0), (Vec3::X, 0.5), (Vec3::Z, 0.5), (Vec3::NEG_Y, 0.0)] {
            let found = evaluate(&factors, normal);
            assert!((found - expected).abs() < 0.03, "{normal}: {found}");
        }
    }

    #[test]
    fn a_cosine_lobe_gives_the_exact_irradiance_along_each_axis() {
        for axis in
            [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 1.0, 0.0).normalize(), Vec3::new(0.0, 0.6, 0.8)]
        {
            let factors = irradiance_over_pi(|direction| Vec3::splat(direction.dot(axis).max(0.0)));
            // The integral of the squared cosine over a hemisphere is 2π/3.
            let found = evaluate(&factors, axis);
            assert!((found - 2.0 / 3.0).abs() < 0.02, "{axis}: {found}");
        }
    }
}
