//! A value over time, by keyframes.

use glam::{DQuat, DVec4};

/// How values between keyframes are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the keyframe before.
    Step,
    /// Linear; rotations along the shortest arc at constant speed (Shoemake, "Animating Rotation with Quaternion Curves", 1985).
    Linear,
    /// Cubic Hermite splines with a tangent on each side of each keyframe (glTF 2.0, appendix C.5).
    CubicSpline,
}

impl Interpolation {
    /// Returns the number of values of a keyframe: splines have a tangent before and after the value.
    #[must_use]
    pub fn values_per_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// A value of some components over time. Before the first keyframe and after the last it is constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Seconds, ascending, at least one.
    times_s: Vec<f32>,
    /// The components of each keyframe; for splines: incoming tangent, value, outgoing tangent.
    values: Vec<f32>,
    width: usize,
    interpolation: Interpolation,
}

impl Curve {
    /// Creates a curve of `width` components per value. Splines need three values for each time: the incoming tangent, the value and
    /// the outgoing tangent.
    ///
    /// # Errors
    /// One line, for times that are not ascending from 0, no times, values that are not finite and another number of values.
    pub fn new(
        times_s: Vec<f32>,
        values: Vec<f32>,
        width: usize,
        interpolation: Interpolation,
    ) -> Result<Self, String> {
        let mut before = None;
        for (key, &time_s) in times_s.iter().enumerate() {
            if !(time_s.is_finite() && time_s >= 0.0 && before.is_none_or(|before| before < time_s)) {
                return Err(format!("time {key} is {time_s} s (allowed: finite, at least 0, ascending)"));
            }
            before = Some(time_s);
        }
        let per_key = interpolation.values_per_key();
        let expected = times_s.len().checked_mul(width * per_key);
        if times_s.is_empty() || width == 0 || expected != Some(values.len()) {
            let (keys, count) = (times_s.len(), values.len());
            return Err(format!(
                "{count} numbers for {keys} keyframes (allowed: {} for each of at least 1)",
                width * per_key
            ));
        }
        match values.iter().position(|value| !value.is_finite()) {
            Some(index) => Err(format!("value {index} is {} (allowed: finite numbers)", values[index])),
            None => Ok(Self { times_s, values, width, interpolation }),
        }
    }

    /// Returns the number of components of a value.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the time of the last keyframe, seconds.
    #[must_use]
    pub fn end_s(&self) -> f32 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// Writes the value at a time, seconds, component by component. A time that is not a number counts as 0.
    pub fn sample(&self, time_s: f64, value: &mut [f64]) {
        for (component, value) in value.iter_mut().enumerate().take(self.width) {
            *value = self.sample_component(time_s, component);
        }
    }

    /// Returns one component of the value at a time, seconds; 0 if there is no such component.
    #[must_use]
    pub fn sample_component(&self, time_s: f64, component: usize) -> f64 {
        if component >= self.width {
            return 0.0;
        }
        let (first, fraction, duration_s) = self.segment(time_s);
        let key = |key: usize| self.component(key, 1, component);
        match self.interpolation {
            Interpolation::Step => key(first),
            Interpolation::Linear => key(first) + (key(first + 1) - key(first)) * fraction,
            Interpolation::CubicSpline => {
                let leaving = self.component(first, 2, component) * duration_s;
                let arriving = self.component(first + 1, 0, component) * duration_s;
                hermite(key(first), leaving, key(first + 1), arriving, fraction)
            }
        }
    }

    /// Returns the value at a time, seconds, as a rotation of length 1. The curve must have four components.
    #[must_use]
    pub fn sample_rotation(&self, time_s: f64) -> DQuat {
        let (first, fraction, _) = self.segment(time_s);
        let key = |key: usize| rotation(std::array::from_fn(|component| self.component(key, 1, component)));
        match self.interpolation {
            Interpolation::Step => key(first),
            Interpolation::Linear => key(first).slerp(key(first + 1), fraction),
            Interpolation::CubicSpline => {
                let mut value = [0.0; 4];
                self.sample(time_s, &mut value);
                rotation(value)
            }
        }
    }

    /// Returns the keyframe before a time, the fraction of the way to the next, 0 to 1, and the seconds between the two.
    fn segment(&self, time_s: f64) -> (usize, f64, f64) {
        let after = self.times_s.partition_point(|&key| f64::from(key) <= time_s);
        let (Some(before), Some(&end)) = (after.checked_sub(1), self.times_s.get(after)) else {
            return (after.saturating_sub(1), 0.0, 0.0);
        };
        let start = f64::from(self.times_s[before]);
        let duration_s = f64::from(end) - start;
        (before, (time_s - start) / duration_s, duration_s)
    }

    /// Returns a component of a keyframe, the last where there is no such keyframe. `part` is 0 for the incoming tangent of a
    /// spline, 1 for the value, 2 for the outgoing tangent.
    fn component(&self, key: usize, part: usize, component: usize) -> f64 {
        let key = key.min(self.times_s.len() - 1);
        let value = if self.interpolation == Interpolation::CubicSpline { key * 3 + part } else { key };
        self.values.get(value * self.width + component).copied().map_or(0.0, f64::from)
    }
}

/// The cubic Hermite spline from `start` to `end`; tangents are per segment, `t` is 0 to 1.
fn hermite(start: f64, leaving: f64, end: f64, arriving: f64, t: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * start
        + (t3 - 2.0 * t2 + t) * leaving
        + (3.0 * t2 - 2.0 * t3) * end
        + (t3 - t2) * arriving
}

/// Returns a rotation of length 1; none for what has no direction.
fn rotation(value: [f64; 4]) -> DQuat {
    let value = DVec4::from_array(value);
    DQuat::from_vec4(value.normalize_or(DVec4::W))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn curve(interpolation: Interpolation, values: &[f32]) -> Curve {
        Curve::new(vec![1.0, 2.0, 4.0], values.to_vec(), 1, interpolation).unwrap()
    }

    fn sampled(curve: &Curve, time_s: f64) -> f64 {
        let mut value = [f64::NAN];
        curve.sample(time_s, &mut value);
        value[0]
    }

    #[test]
    fn steps_keep_the_value_of_the_keyframe_before() {
        let curve = curve(Interpolation::Step, &[10.0, 20.0, 40.0]);
        let values = [-1.0, 1.0, 1.99, 2.0, 3.999, 4.0, 1e9].map(|time_s| sampled(&curve, time_s));
        assert_eq!(values, [10.0, 10.0, 10.0, 20.0, 20.0, 40.0, 40.0]);
        assert_eq!(sampled(&curve, f64::NAN), 10.0);
    }

    #[test]
    fn linear_values_are_proportional_to_time() {
        let curve = curve(Interpolation::Linear, &[10.0, 20.0, 40.0]);
        let values = [0.0, 1.0, 1.25, 2.0, 3.0, 4.0, f64::INFINITY].map(|time_s| sampled(&curve, time_s));
        assert_eq!(values, [10.0, 10.0, 12.5, 20.0, 30.0, 40.0, 40.0]);
    }

    #[test]
    fn splines_reproduce_a_cubic_polynomial() {
        let value = |t: f64| 2.0 * t.powi(3) - 5.0 * t.powi(2) + t - 3.0;
        let slope = |t: f64| 6.0 * t.powi(2) - 10.0 * t + 1.0;
        let key = |t: f64| [slope(t), value(t), slope(t)].map(|number| number as f32);
        let curve = curve(Interpolation::CubicSpline, &[key(1.0), key(2.0), key(4.0)].concat());
        for step in 0..=30 {
            let time_s = 1.0 + f64::from(step) * 0.1;
            assert!((sampled(&curve, time_s) - value(time_s)).abs() < 1e-12, "at {time_s} s");
        }
    }

    #[test]
    fn rotations_turn_at_constant_speed_along_the_shortest_arc() {
        let start = DQuat::IDENTITY;
        let end = DQuat::from_rotation_y(FRAC_PI_2);
        for sign in [1.0, -1.0] {
            let values = [start.to_array(), (end * sign).to_array()].concat();
            let values = values.into_iter().map(|number| number as f32).collect();
            let curve = Curve::new(vec![0.0, 1.0], values, 4, Interpolation::Linear).unwrap();
            for step in 0..=8 {
                let fraction = f64::from(step) / 8.0;
                let expected = DQuat::from_rotation_y(FRAC_PI_2 * fraction);
                assert!(curve.sample_rotation(fraction).angle_between(expected) < 1e-6, "{fraction}");
            }
        }
    }

    #[test]
    fn rotations_of_splines_have_length_1() {
        let key = |rotation: DQuat| [DQuat::from_array([0.0; 4]), rotation, DQuat::from_array([0.0; 4])];
        let keys = [key(DQuat::IDENTITY), key(DQuat::from_rotation_x(2.0))].concat();
        let values = keys.iter().flat_map(|key| key.to_array()).map(|number| number as f32).collect();
        let curve = Curve::new(vec![0.0, 1.0], values, 4, Interpolation::CubicSpline).unwrap();
        let middle = curve.sample_rotation(0.5);
        assert!((middle.length() - 1.0).abs() < 1e-12);
        assert!(middle.angle_between(DQuat::from_rotation_x(1.0)) < 1e-6);
    }

    #[test]
    fn malformed_keyframes_are_refused_in_one_line() {
        let new = |times: &[f32], values: &[f32], interpolation| {
            Curve::new(times.to_vec(), values.to_vec(), 1, interpolation).unwrap_err()
        };
        let linear = Interpolation::Linear;
        assert_eq!(
            new(&[0.0, 2.0, 2.0], &[0.0; 3], linear),
            "time 2 is 2 s (allowed: finite, at least 0, ascending)"
        );
        assert_eq!(new(&[-1.0], &[0.0], linear), "time 0 is -1 s (allowed: finite, at least 0, ascending)");
        assert_eq!(
            new(&[f32::NAN], &[0.0], linear),
            "time 0 is NaN s (allowed: finite, at least 0, ascending)"
        );
        assert_eq!(new(&[], &[], linear), "0 numbers for 0 keyframes (allowed: 1 for each of at least 1)");
        assert_eq!(
            new(&[0.0], &[0.0], Interpolation::CubicSpline),
            "1 numbers for 1 keyframes (allowed: 3 for each of at least 1)"
        );
        assert_eq!(new(&[0.0], &[f32::INFINITY], linear), "value 0 is inf (allowed: finite numbers)");
    }
}
