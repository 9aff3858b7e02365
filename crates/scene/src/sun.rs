//! The sun's direction at a time, on a day, at a latitude.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A moment at a place, for the position of the sun.
///
/// The hour is true solar time: at 12 the sun is due south (on the northern hemisphere) and highest. Clocks differ from it by the
/// longitude within the time zone, daylight saving, and the equation of time (up to 17 minutes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolarTime {
    /// True solar time, hours from midnight; may be outside 0 to 24.
    pub hour: f64,
    /// Day of the year, from 1 for the first of January.
    pub day: f64,
    /// Geographic latitude, radians from -π/2 (south pole) to π/2.
    pub latitude: f64,
}

/// A direction to the sky in horizontal coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyDirection {
    /// Angle from north (-Z) over east (+X), radians.
    pub azimuth: f64,
    /// Angle above the horizon, radians from -π/2 to π/2.
    pub elevation: f64,
}

impl SolarTime {
    /// Returns the unit direction to the sun: +Y up, north -Z, east +X. Below the horizon y is negative.
    ///
    /// Refraction and parallax are left out, so the sun near the horizon is up to 0.6 degrees lower than it looks.
    ///
    /// ```
    /// use shadowgraph_scene::SolarTime;
    /// let noon = SolarTime { hour: 12.0, day: 172.0, latitude: 52.5f64.to_radians() };
    /// let elevation_deg = noon.to_sun().y.asin().to_degrees();
    /// assert!((elevation_deg - 60.94).abs() < 0.05);
    /// ```
    #[must_use]
    pub fn to_sun(&self) -> DVec3 {
        let (sin_hour, cos_hour) = (PI / 12.0 * (self.hour - 12.0)).sin_cos();
        let (sin_declination, cos_declination) = self.declination().sin_cos();
        let (sin_latitude, cos_latitude) = self.latitude.sin_cos();
        let up = sin_latitude * sin_declination + cos_latitude * cos_declination * cos_hour;
        let north = cos_latitude * sin_declination - sin_latitude * cos_declination * cos_hour;
        DVec3::new(-cos_declination * sin_hour, up, -north)
    }

    /// Returns the declination of the sun, radians: the low-precision formula of the Astronomical Almanac (page C5), for a year in the
    /// middle between leap years, so of any year it is within 0.2 degrees. It is continuous from one day to the next.
    fn declination(&self) -> f64 {
        let days = self.day - 0.5 + (self.hour - 12.0) / 24.0;
        let mean_longitude = (280.460 + 0.985_647_4 * days).to_radians();
        let mean_anomaly = (357.528 + 0.985_600_3 * days).to_radians();
        let equation_of_center_deg = 1.915 * mean_anomaly.sin() + 0.020 * (2.0 * mean_anomaly).sin();
        let longitude = mean_longitude + equation_of_center_deg.to_radians();
        let obliquity = 23.439_f64.to_radians();
        (obliquity.sin() * longitude.sin()).asin()
    }
}

impl SkyDirection {
    /// Returns the horizontal coordinates of a direction (not zero), with an azimuth from 0 to below 2π. That of the zenith and the
    /// nadir is 0.
    #[must_use]
    pub fn from_vector(direction: DVec3) -> Self {
        let DVec3 { x, y, z } = direction;
        let across = x.hypot(z);
        let azimuth = if across > 0.0 { x.atan2(-z).rem_euclid(TAU) } else { 0.0 };
        Self { azimuth: if azimuth < TAU { azimuth } else { 0.0 }, elevation: y.atan2(across) }
    }

    /// Returns the unit vector in this direction: +Y up, north -Z, east +X.
    ///
    /// ```
    /// use shadowgraph_scene::SkyDirection;
    /// let south_east = SkyDirection { azimuth: 135f64.to_radians(), elevation: 0.0 };
    /// assert!(south_east.to_vector().distance(glam::DVec3::new(0.5, 0.0, 0.5).normalize()) < 1e-12);
    /// ```
    #[must_use]
    pub fn to_vector(self) -> DVec3 {
        let (sin, cos) = self.azimuth.sin_cos();
        let elevation = self.elevation.clamp(-FRAC_PI_2, FRAC_PI_2);
        DVec3::new(sin * elevation.cos(), elevation.sin(), -cos * elevation.cos())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns azimuth and elevation, degrees.
    fn sky(hour: f64, day: f64, latitude_deg: f64) -> (f64, f64) {
        let time = SolarTime { hour, day, latitude: latitude_deg.to_radians() };
        let to_sun = time.to_sun();
        assert!((to_sun.length() - 1.0).abs() < 1e-12);
        let sky = SkyDirection::from_vector(to_sun);
        (sky.azimuth.to_degrees(), sky.elevation.to_degrees())
    }

    #[test]
    fn the_noon_sun_has_the_known_elevations_of_solstices_and_equinoxes() {
        // The obliquity of the ecliptic is 23.44 degrees.
        for (day, latitude, azimuth, elevation) in [
            (172.0, 52.5, 180.0, 90.0 - 52.5 + 23.44),
            (355.0, 52.5, 180.0, 90.0 - 52.5 - 23.44),
            (80.0, 52.5, 180.0, 90.0 - 52.5),
            (172.0, -33.9, 0.0, 90.0 - 33.9 - 23.44),
            (172.0, 0.0, 0.0, 90.0 - 23.44),
            (355.0, 80.0, 180.0, -13.44),
        ] {
            let (found_azimuth, found_elevation) = sky(12.0, day, latitude);
            let across = (found_azimuth - azimuth + 180.0).rem_euclid(360.0) - 180.0;
            assert!(across.abs() < 1e-6, "day {day} at {latitude}: azimuth {found_azimuth}");
            assert!((found_elevation - elevation).abs() < 0.3, "day {day} at {latitude}: {found_elevation}");
        }
    }

    #[test]
    fn declinations_follow_the_almanac() {
        // Of 2023 at noon UT.
        for (day, declination) in
            [(1.0, -23.00), (46.0, -12.67), (80.0, 0.24), (135.0, 18.87), (172.0, 23.44), (288.0, -8.52)]
        {
            let found = SolarTime { hour: 12.0, day, latitude: 0.0 }.declination().to_degrees();
            assert!((found - declination).abs() < 0.1, "day {day}: {found}");
        }
    }

    #[test]
    fn the_sun_rises_in_the_east_and_sets_in_the_west_at_the_equinox() {
        let (azimuth, elevation) = sky(6.0, 80.0, 52.5);
        assert!((azimuth - 90.0).abs() < 0.5 && elevation.abs() < 0.5, "{azimuth} {elevation}");
        let (azimuth, elevation) = sky(18.0, 80.0, 52.5);
        assert!((azimuth - 270.0).abs() < 0.5 && elevation.abs() < 0.5, "{azimuth} {elevation}");
        // 15 degrees an hour around the celestial pole.
        let morning = sky(9.0, 172.0, 52.5);
        assert!((90.0..180.0).contains(&morning.0), "{morning:?}");
    }

    #[test]
    fn midnight_of_one_day_is_that_of_the_next() {
        let time = |hour, day| SolarTime { hour, day, latitude: 0.9 }.to_sun();
        assert!(time(24.0, 100.0).distance(time(0.0, 101.0)) < 1e-12);
        assert!(sky(0.0, 172.0, 70.0).1 > 0.0, "midnight sun");
    }

    #[test]
    fn horizontal_coordinates_are_converted_back_and_forth() {
        for azimuth in [0.0, 0.5, 2.0, 4.0, 6.2] {
            for elevation in [-1.5, -0.2, 0.0, 0.7, 1.5] {
                let sky = SkyDirection { azimuth, elevation };
                let back = SkyDirection::from_vector(sky.to_vector() * 3.0);
                assert!((back.azimuth - azimuth).abs() < 1e-9, "{back:?} of {sky:?}");
                assert!((back.elevation - elevation).abs() < 1e-9, "{back:?} of {sky:?}");
            }
        }
        let zenith = SkyDirection::from_vector(DVec3::Y);
        assert_eq!((zenith.azimuth, zenith.elevation), (0.0, FRAC_PI_2));
    }
}
