//! Times fixel and its peers on the same scenes; prints a table, writes it beside criterion's records, and draws
//! `peers.svg`. See README.md.

use fixel_peers::chart::chart;
use fixel_peers::libraries::LIBRARIES;
use fixel_peers::measure::measure;
use fixel_peers::table::table;
use std::error::Error;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = package.join("target").join("peers");
    fs::create_dir_all(&output)?;
    let rows = measure(&LIBRARIES, &output.join("criterion"))?;
    let table = table(&LIBRARIES, &rows);
    println!("{table}");
    fs::write(output.join("table.md"), &table)?;
    chart(&LIBRARIES, &rows, &package.join("peers.svg"))?;
    println!("Written: target/peers/table.md and peers.svg in {}", package.display());
    Ok(())
}
