//! How long a frame takes: criterion measures, its medians are read back.

use crate::library::{Library, Painter};
use crate::scene::{SCENES, Scene};
use criterion::{BenchmarkId, Criterion};
use serde::Deserialize;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Times everything so often, one library after another each time: a machine is seldom left alone for minutes.
const ROUNDS: usize = 3;

/// A row of the table: one scene, all libraries.
#[derive(Clone, Debug)]
pub struct Row {
    /// What was drawn.
    pub scene: &'static Scene,
    /// Time of a frame in microseconds for each library in its place, or why there is none: the median of the
    /// calmest round.
    pub micros: Vec<Result<f64, &'static str>>,
}

/// Times all scenes with all libraries; criterion keeps its records in `directory`.
///
/// # Errors
///
/// If criterion's records cannot be read.
pub fn measure(libraries: &[&dyn Library], directory: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut criterion = Criterion::default()
        .without_plots()
        .sample_size(30)
        .nresamples(2_000)
        .warm_up_time(Duration::from_millis(150))
        .measurement_time(Duration::from_millis(500))
        .output_directory(directory);
    let unmeasured = |scene| Row { scene, micros: vec![Ok(f64::INFINITY); libraries.len()] };
    let mut rows: Vec<Row> = SCENES.iter().map(unmeasured).collect();
    for round in 1..=ROUNDS {
        for row in &mut rows {
            let name = row.scene.name;
            for (library, least) in libraries.iter().zip(&mut row.micros) {
                *least = match (library.painter(row.scene), *least) {
                    (Ok(mut painter), Ok(least)) => {
                        let mut group = criterion.benchmark_group(name);
                        group.bench_function(BenchmarkId::new(library.name(), round), |bencher| {
                            bencher.iter_custom(|frames| time(&mut *painter, frames));
                        });
                        group.finish();
                        let record = directory.join(name).join(library.name()).join(round.to_string());
                        Ok(median(&record)?.min(least))
                    }
                    (Err(reason), _) | (_, Err(reason)) => Err(reason),
                };
            }
        }
    }
    Ok(rows)
}

/// Frames one after another, the time to clear them left out.
fn time(painter: &mut dyn Painter, frames: u64) -> Duration {
    let mut total = Duration::ZERO;
    for _ in 0..frames {
        painter.clear(0);
        let start = Instant::now();
        painter.draw();
        total += start.elapsed();
    }
    total
}

/// What criterion writes, as far as it is of interest: nanoseconds.
#[derive(Deserialize)]
struct Estimates {
    median: Estimate,
}

#[derive(Deserialize)]
struct Estimate {
    point_estimate: f64,
}

fn median(record: &Path) -> Result<f64, Box<dyn Error>> {
    let path = record.join("new").join("estimates.json");
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let estimates: Estimates = serde_json::from_str(&text)?;
    Ok(estimates.median.point_estimate / 1000.0)
}
