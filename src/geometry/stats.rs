//! Counts of what became of the meshes and triangles that were drawn.

/// What became of the meshes that [`Camera::draw_counted`](crate::Camera::draw_counted) drew. Counts add up
/// over calls, and saturate. [`troubleshooting`](crate::guide::troubleshooting) has what each of them tells of a picture that is
/// not as it should be, [`speed`](crate::guide::speed) estimates a frame from them.
///
/// ```
/// use fixel::embedded_graphics::{pixelcolor::Rgb565, prelude::*};
/// use fixel::{Stats, prelude::*, shapes};
/// static CUBE: shapes::Shape<24, 12> = shapes::cube(2.0, [2, 2]);
/// # let (mut pixels, mut depth) = ([0; 64 * 64], [0; 64 * 64]);
/// # let mut band = Band::<Rgb565, Depth16>::new(Size::new(64, 64), &mut pixels, &mut depth).unwrap();
/// let camera = Camera::perspective(Turn::from_degrees(60), Size::new(64, 64)).at(Vec3::lit(0.0, 0.0, 5.0));
/// let mut stats = Stats::default();
/// camera.draw_counted(&CUBE.mesh(), &Pose::IDENTITY, &Material::gouraud(), &mut band, &mut stats);
/// assert_eq!([stats.triangles, stats.culled, stats.drawn], [12, 10, 2]); // one face is seen straight on
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Meshes drawn, those left out included.
    pub meshes: u32,
    /// Meshes left out whole, because their bounding sphere was out of sight.
    pub meshes_out_of_sight: u32,
    /// Triangles of the other meshes.
    pub triangles: u32,
    /// How often a vertex was transformed; less than three times a triangle by what the vertex cache saved.
    pub transformed: u32,
    /// Triangles that were cut at a plane or at the guard band, or lie so near the eye that they were treated as such.
    pub clipped: u32,
    /// Triangles, or pieces of clipped ones, left out because they had no area or faced the wrong way.
    pub culled: u32,
    /// Triangles or pieces without a row in the viewport, or in the band.
    pub out_of_sight: u32,
    /// Triangles or pieces drawn.
    pub drawn: u32,
}

/// Where a draw counts: in [`Stats`], or nowhere at no cost.
pub trait Count {
    fn count(&mut self, what: impl FnOnce(&mut Stats) -> &mut u32);

    /// Itself, if it counts.
    fn stats(&mut self) -> Option<&mut Stats>;
}

impl Count for () {
    #[inline]
    fn count(&mut self, _: impl FnOnce(&mut Stats) -> &mut u32) {}

    #[inline]
    fn stats(&mut self) -> Option<&mut Stats> {
        None
    }
}

impl Count for Stats {
    #[inline]
    fn count(&mut self, what: impl FnOnce(&mut Stats) -> &mut u32) {
        let counter = what(self);
        *counter = counter.saturating_add(1);
    }

    #[inline]
    fn stats(&mut self) -> Option<&mut Stats> {
        Some(self)
    }
}
