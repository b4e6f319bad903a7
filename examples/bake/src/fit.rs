//! How a model's units become those of a mesh: −8 … 7.9998 in steps of 1/4096, which the scale of a pose makes larger or smaller.

/// Where the origin of meshes is in the model, and how large their unit is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The scale for the pose: world units a mesh unit. A power of two, so that what was exact stays exact.
    pub scale: f64,
    /// World units a model unit: 1, unless asked for or the model is larger than a pose can make it.
    pub unit: f64,
    /// The point of the model, in its own units, that is the mesh's origin.
    pub origin: [f64; 3],
}

/// The largest scale, below the 1024 of a pose.
const LARGEST: f64 = 512.0;
/// The smallest: the scale of a pose has 22 fraction bits.
const SMALLEST: f64 = 1.0 / 1024.0;
/// The largest coordinate that surely fits, half a step less than the format's end.
const MOST: f64 = 7.9996;

impl Fit {
    /// For points between `low` and `high`.
    pub(crate) fn new(low: [f64; 3], high: [f64; 3], origin: [f64; 3], unit: Option<f64>) -> Self {
        let reach = (0..3).map(|i| (high[i] - origin[i]).max(origin[i] - low[i])).fold(0.0, f64::max);
        let scale_of = |unit: f64| if reach > 0.0 { (reach * unit / MOST).log2().ceil().exp2() } else { 1.0 };
        let unit = unit.unwrap_or_else(|| {
            let scale = scale_of(1.0);
            if scale > LARGEST { LARGEST / scale } else { 1.0 }
        });
        Self { scale: scale_of(unit).clamp(SMALLEST, LARGEST), unit, origin }
    }

    /// Whether the largest coordinate fits.
    pub(crate) fn holds(&self, low: [f64; 3], high: [f64; 3]) -> bool {
        [low, high].iter().all(|corner| {
            let mesh = [0, 1, 2].map(|i| (corner[i] - self.origin[i]) * self.unit / self.scale);
            mesh.iter().all(|at| at.abs() <= MOST + 1e-9)
        })
    }

    /// Bits of I4F12.
    pub(crate) fn bits(&self, position: [f32; 3]) -> [i16; 3] {
        [0, 1, 2].map(|i| {
            let mesh = (f64::from(position[i]) - self.origin[i]) * self.unit / self.scale;
            (mesh * 4096.0).round() as i16
        })
    }

    /// Back to the model's units.
    #[must_use]
    pub fn model(&self, bits: [i16; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| f64::from(bits[i]) / 4096.0 * self.scale / self.unit + self.origin[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_the_least_power_of_two_that_holds_the_model() {
        for (reach, scale) in
            [(1.0, 0.25), (0.99, 0.125), (7.9, 1.0), (8.0, 2.0), (0.5, 0.125), (4095.0, 512.0)]
        {
            let fit = Fit::new([-reach, 0.0, 0.0], [reach / 2.0; 3], [0.0; 3], None);
            assert_eq!((fit.scale, fit.unit), (scale, 1.0), "{reach}");
            assert!(fit.holds([-reach, 0.0, 0.0], [reach / 2.0; 3]));
        }
        let fit = Fit::new([0.0; 3], [1e6, 1.0, 1.0], [0.0; 3], None);
        assert_eq!((fit.scale, fit.unit), (512.0, 2.0_f64.powi(-8)));
        assert!(fit.holds([0.0; 3], [1e6, 1.0, 1.0]));
        assert_eq!(Fit::new([3.0; 3], [3.0; 3], [3.0; 3], None).scale, 1.0);
    }
}
