//! What is said of a baked model.

use crate::baked::{Baked, Paint};
use crate::cost;
use crate::write::short;
use std::fmt;

/// A frame that cycles are estimated for: so many pixels wide and high.
const FRAME: u32 = 160;

/// 12345 → `12 345`.
fn grouped(number: f64) -> String {
    let digits = format!("{number:.0}");
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

fn bytes(count: usize) -> String {
    if count < 10_000 {
        format!("{} B", grouped(count as f64))
    } else {
        format!("{:.1} KiB", count as f64 / 1024.0)
    }
}

/// Triangles, flash, RAM, cycles: what a program has to reckon with.
impl fmt::Display for Baked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &self.report;
        let each = |count: usize| count as f64 / report.triangles as f64;
        let mut line = |label: &str, text: String| writeln!(f, "  {label:<16} {text}");
        line("triangles", format!("{} of {} read", report.triangles, report.triangles_read))?;
        line("vertices", format!("{}, in {} draws", report.vertices, self.meshes.len()))?;
        line(
            "vertex order",
            format!(
                "{:.3} transforms a triangle, {:.3} in the order of the file",
                each(report.transforms),
                each(report.transforms_before)
            ),
        )?;
        let [low, high] = report.bounds;
        let size = [0, 1, 2].map(|i| short(high[i] - low[i]));
        line("size", format!("{} × {} × {} model units", size[0], size[1], size[2]))?;
        let mut scale = format!(
            "scale {}; the largest error is {} model units",
            self.fit.scale,
            short(report.largest_error)
        );
        if self.fit.unit != 1.0 {
            scale.push_str(&format!("; a model unit is {} world units", self.fit.unit));
        }
        if self.fit.origin != [0.0; 3] {
            let [x, y, z] = self.fit.origin.map(short);
            scale.push_str(&format!("; its origin is ({x}, {y}, {z}) of the model"));
        }
        line("pose", scale)?;
        if report.computed_normals > 0 {
            line("normals", format!("of {} corners computed", report.computed_normals))?;
        }
        for texture in &self.textures {
            let ([width, height], size) = (texture.source, texture.size());
            let mask = if texture.mask.is_some() { ", with a mask" } else { "" };
            line(
                "texture",
                format!("{}: {width} × {height} → {} × {}{mask}", texture.name, size.width, size.height),
            )?;
        }
        for material in &self.materials {
            let mut text = match material.paint {
                Paint::Flat(color) => format!("flat {color:#06x}"),
                Paint::Gouraud => "colours of vertices".into(),
                Paint::Texture { is_clamped: true, .. } => "texture, clamped".into(),
                Paint::Texture { .. } => "texture".into(),
            };
            for (is, what) in [(material.is_lit, ", lit"), (material.is_two_sided, ", two-sided")] {
                text.push_str(if is { what } else { "" });
            }
            if let Some(alpha) = material.alpha {
                text.push_str(&format!(", alpha {alpha}"));
            }
            let name = if material.name.is_empty() { "(no name)" } else { &material.name };
            line("material", format!("{name}: {text}"))?;
        }
        line("flash", format!("{}, without fixel's code", bytes(self.flash())))?;
        let ram = |[vertices, triangles]: [usize; 2]| bytes(16 * vertices + 10 * triangles);
        line(
            "display list",
            format!(
                "{} of RAM; {} if planes cut every triangle",
                ram(self.in_list()),
                ram(self.most_in_list())
            ),
        )?;
        let (cycles, covered) = cost::of_a_frame(self, FRAME);
        line(
            "a frame",
            format!(
                "about {} cycles on a Cortex-M0+, {} on a Cortex-M4F: {FRAME} × {FRAME}, {} pixels covered",
                grouped((cycles[0] / 1000.0).round() * 1000.0),
                grouped((cycles[1] / 1000.0).round() * 1000.0),
                grouped(covered)
            ),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped() {
        assert_eq!(grouped(1_234_567.0), "1 234 567");
        assert_eq!(grouped(12.0), "12");
        assert_eq!(bytes(20_480), "20.0 KiB");
    }
}
