//! What a frame takes: figures of the page `cost` of fixel's documentation, times what was counted.
//!
//! - In: a baked model.
//! - Out: cycles on a Cortex-M0+ and a Cortex-M4F.
//! - Assumes: the figures are those of `src/cost.md`; a test looks.

use crate::baked::{Baked, BakedMaterial, Paint};
use crate::view;
use fixel::Stats;

/// Cycles on a Cortex-M0+ and on a Cortex-M4F.
pub type Cycles = [f64; 2];

/// Views of a turntable that are averaged.
const VIEWS: u32 = 8;

const CALL: Cycles = [9818.0, 4191.0];
const CALL_LIT: Cycles = [11667.0, 5363.0];
const VERTEX: Cycles = [481.0, 267.0];
const VERTEX_LIT: Cycles = [153.0, 127.0];
const CULLED: Cycles = [144.0, 94.0];
/// A triangle of 1 pixel, one of 21 pixels in 6 rows: flat, Gouraud, textured, texture × light.
const TRIANGLES: [[Cycles; 2]; 4] = [
    [[1137.0, 752.0], [1562.0, 1040.0]],
    [[2746.0, 1846.0], [4447.0, 2941.0]],
    [[2708.0, 1825.0], [4350.0, 2965.0]],
    [[3079.0, 2065.0], [5857.0, 3665.0]],
];
/// A row and a pixel more of a small triangle.
const SMALL_ROW: Cycles = [150.0, 110.0];
const SMALL_PIXEL: Cycles = [37.0, 21.0];
/// A row and a pixel of a large one, of a floor with depth: flat, Gouraud, textured, texture × light; clamped as repeated.
const LARGE: [[Cycles; 2]; 4] = [
    [[331.0, 251.0], [12.4, 9.8]],
    [[866.0, 596.0], [34.8, 22.5]],
    [[793.0, 520.0], [20.1, 15.8]],
    [[949.0, 655.0], [80.9, 45.9]],
];
/// The same cut out by a mask, or with alpha: flat, textured; texture × light.
const MASKED: [Cycles; 2] = [[209.0, 158.0], [228.8, 142.4]];
const FLAT_ALPHA: [Cycles; 2] = [[324.0, 241.0], [92.9, 49.1]];
const ALPHA: [Cycles; 2] = [[325.0, 241.0], [115.0, 63.5]];
const LIT_ALPHA: [Cycles; 2] = [[325.0, 241.0], [180.6, 97.8]];
/// What a row of a small triangle takes more that is not opaque.
const ROW_OF_SMALL: Cycles = [600.0, 400.0];

/// Rows of a triangle of so many pixels: the page's of 21 has 6, and of 40 has 9.
fn rows_of(pixels: f64) -> f64 {
    (1.36 * pixels.sqrt()).max(1.0)
}

/// What a mesh takes of a frame.
fn mesh(material: &BakedMaterial, stats: &Stats, pixels: usize) -> Cycles {
    let kind = match (material.paint, material.is_lit) {
        (Paint::Flat(_), false) => 0,
        (Paint::Flat(_) | Paint::Gouraud, _) => 1,
        (Paint::Texture { .. }, false) => 2,
        (Paint::Texture { .. }, true) => 3,
    };
    let is_masked = matches!(material.paint, Paint::Texture { is_masked: true, .. });
    let special = match (material.alpha.is_some(), kind) {
        (true, 0 | 1) => Some(FLAT_ALPHA),
        (true, 2) => Some(ALPHA),
        (true, _) => Some(LIT_ALPHA),
        (false, _) if is_masked => Some(MASKED),
        (false, _) => None,
    };
    let drawn = f64::from(stats.drawn);
    let each = if drawn > 0.0 { pixels as f64 / drawn } else { 0.0 };
    let lit_share = drawn / f64::from(stats.drawn + stats.culled).max(1.0);
    [0, 1].map(|core| {
        let call = if material.is_lit { CALL_LIT[core] } else { CALL[core] };
        let lit = if material.is_lit { VERTEX_LIT[core] * lit_share } else { 0.0 };
        let [one, twenty_one] = TRIANGLES[kind].map(|figure| figure[core]);
        let rows = rows_of(each);
        let triangle = if let Some([row, pixel]) = special {
            one + rows * (row[core] + ROW_OF_SMALL[core]) + each * pixel[core]
        } else if each <= 21.0 {
            one + (twenty_one - one) * (each - 1.0).max(0.0) / 20.0
        } else {
            let small =
                twenty_one + SMALL_ROW[core] * (rows - 6.0).max(0.0) + SMALL_PIXEL[core] * (each - 21.0);
            let [row, pixel] = LARGE[kind].map(|figure| figure[core]);
            // More than 32 rows of a triangle are drawn as large ones are.
            if rows <= 32.0 { small } else { one + rows * row + each * pixel }
        };
        call + f64::from(stats.transformed) * (VERTEX[core] + lit)
            + f64::from(stats.culled) * CULLED[core]
            + drawn * triangle
    })
}

/// What a frame of `size` × `size` pixels takes that shows the whole model, on average over a turn; and how many pixels it covers.
#[must_use]
pub fn of_a_frame(baked: &Baked, size: u32) -> (Cycles, f64) {
    let mut sum = [0.0; 2];
    let mut covered = 0.0;
    for number in 0..VIEWS {
        let (_, frame) = view::draw(baked, size, [f64::from(number) * 360.0 / f64::from(VIEWS), 20.0]);
        covered += frame.covered as f64;
        for ((baked_mesh, stats), pixels) in baked.meshes.iter().zip(&frame.stats).zip(&frame.pixels) {
            let cycles = mesh(&baked.materials[baked_mesh.material], stats, *pixels);
            sum = [sum[0] + cycles[0], sum[1] + cycles[1]];
        }
    }
    let views = f64::from(VIEWS);
    (sum.map(|cycles| cycles / views), covered / views)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figures_are_those_of_the_page() {
        let page = include_str!("../../../src/cost.md");
        let plain = |label: &str, cycles: Cycles| {
            let row = format!("| {label} | {} | {} |", cycles[0], cycles[1]);
            assert!(page.contains(&row), "the page has no {row}");
        };
        plain("… that is in sight, without its vertices and triangles", CALL);
        plain("… with a directional light", CALL_LIT);
        plain("a vertex", VERTEX);
        plain("… its light from one directional light", VERTEX_LIT);
        plain("a culled triangle", CULLED);
        for (kind, figures) in ["flat", "Gouraud", "textured", "texture × light"].iter().zip(TRIANGLES) {
            plain(&format!("a drawn triangle of 1 pixel, {kind}"), figures[0]);
            plain(&format!("a drawn triangle of 21 pixels in 6 rows, {kind}"), figures[1]);
        }
        let pair = |[row, pixel]: [Cycles; 2]| {
            format!(" {} / {} | {:.1} / {:.1} |", row[0], row[1], pixel[0], pixel[1])
        };
        for (label, figures) in [
            ("| flat | any | any |", LARGE[0]),
            ("| Gouraud | default | a floor, level |", LARGE[1]),
            ("| texture, repeated | default | a floor, level |", LARGE[2]),
            ("| texture × light | default | a floor, level |", LARGE[3]),
            ("| texture, cut out by a mask |", MASKED),
            ("| flat, alpha |", FLAT_ALPHA),
            ("| texture, alpha |", ALPHA),
            ("| texture × light, alpha |", LIT_ALPHA),
        ] {
            let line = page.lines().find(|line| line.starts_with(label)).expect("a row of the page");
            assert!(line.contains(&pair(figures)), "{line} has no {}", pair(figures));
        }
        assert!(page.contains("150 / 110 cycles") && page.contains("37 / 21"));
        assert!(page.contains("about 600 / 400 a row more"));
    }

    /// The torus of `bench`, whose frames README has as they were counted. The page's figures for texture × light fall short of what was
    /// counted for it by a fifth: its triangles of 21 pixels are cheaper than the torus' of 16 pixels on average.
    #[test]
    fn a_torus_costs_what_was_counted_for_it_within_a_tenth_in_light_and_a_quarter_textured() {
        let stats = Stats { transformed: 696, culled: 580, drawn: 420, ..Stats::default() };
        let material = |paint| BakedMaterial {
            name: String::new(),
            paint,
            is_lit: true,
            alpha: None,
            is_two_sided: false,
        };
        let textured = Paint::Texture { texture: 0, is_clamped: false, is_masked: false };
        for (paint, counted, most) in
            [(Paint::Gouraud, [2.16e6, 1.40e6], 0.1), (textured, [3.41e6, 2.13e6], 0.25)]
        {
            let cycles = mesh(&material(paint), &stats, 6826);
            for (estimated, counted) in cycles.iter().zip(counted) {
                assert!((estimated / counted - 1.0).abs() < most, "{estimated} for {counted}");
            }
        }
    }
}
