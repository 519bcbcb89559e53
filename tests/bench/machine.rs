//! What a table must say besides numbers: the instructions that were used, and the processor.

use rasterbook::tiled::{Instructions, Tiled};

/// The instructions that the program is compiled for, those that `tiled` draws with, and the processor.
pub(crate) fn description() -> String {
    let (baseline, chosen) = (Instructions::baseline(), Tiled::new().instructions());
    format!("compiled for {baseline}, tiled draws with {chosen}, on {}", processor())
}

/// What the processor calls itself, where Linux says so.
fn processor() -> String {
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.to_owned())
}
