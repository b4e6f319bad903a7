//! Pictures: what a painter draws, as PNG and compared.

use crate::library::Painter;
use crate::model::{HEIGHT, WIDTH};
use image::{ImageResult, Rgb, RgbImage};
use std::path::Path;

/// A finished picture.
#[derive(Clone, Debug)]
pub struct Picture {
    words: Vec<u16>,
    covered: Vec<bool>,
}

/// How a picture differs from another.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Covered pixels, as a share of the other's, less 1.
    pub coverage: f32,
    /// Mean difference of the channels of the pixels that both cover, as a share of white.
    pub color: f32,
}

impl Picture {
    /// Draws twice, on black and on white: what differs is ground.
    #[must_use]
    pub fn new(painter: &mut dyn Painter) -> Self {
        let [words, on_white] = [0, 0xffff].map(|ground| {
            painter.clear(ground);
            painter.draw();
            painter.words()
        });
        let covered = words.iter().zip(&on_white).map(|(black, white)| black == white).collect();
        Self { words, covered }
    }

    /// The number of pixels covered.
    #[must_use]
    pub fn covered(&self) -> usize {
        self.covered.iter().filter(|&&covered| covered).count()
    }

    /// How it differs from `other`.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Difference {
        let (mut sum, mut both) = (0.0, 0);
        for i in (0..self.words.len()).filter(|&i| self.covered[i] && other.covered[i]) {
            let (a, b) = (channels(self.words[i]), channels(other.words[i]));
            sum += a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f32>() / 3.0;
            both += 1;
        }
        Difference {
            coverage: self.covered() as f32 / other.covered() as f32 - 1.0,
            color: sum / both.max(1) as f32,
        }
    }

    /// Writes it as PNG, on black.
    ///
    /// # Errors
    ///
    /// What the file system says.
    pub fn save(&self, path: &Path) -> ImageResult<()> {
        let pixel = |x, y| {
            Rgb(channels(self.words[y as usize * WIDTH + x as usize]).map(|c| (c * 255.0).round() as u8))
        };
        RgbImage::from_fn(WIDTH as u32, HEIGHT as u32, pixel).save(path)
    }
}

/// Red, green, blue, 0 … 1.
fn channels(word: u16) -> [f32; 3] {
    [f32::from(word >> 11) / 31.0, f32::from(word >> 5 & 63) / 63.0, f32::from(word & 31) / 31.0]
}
