//! Stored results of the external solvers in `peers/`.

use grainbench_reference::outside::STORED;
use grainbench_reports::judged::ExternalResults;
use grainbench_store::ReadError;
use grainbench_store::artifact::parse_json;
use std::path::Path;

/// Stored results, by the name of the solver's directory in `peers/`.
pub const KEPT: [(&str, &str); 5] = [
    ("yade", include_str!("../peers/yade/judged.json")),
    ("kratos-dem", include_str!("../peers/kratos-dem/judged.json")),
    ("lammps", include_str!("../peers/lammps/judged.json")),
    ("taichi", include_str!("../peers/taichi/judged.json")),
    ("kratos-mpm", include_str!("../peers/kratos-mpm/judged.json")),
];

/// Reads the stored results of all external solvers.
///
/// # Errors
/// When a file cannot be read as stored results. The error names the file.
pub fn kept() -> Result<Vec<ExternalResults>, ReadError> {
    let read = |(name, text): (&str, &str)| parse_json(&Path::new("peers").join(name).join(STORED), text.as_bytes());
    KEPT.into_iter().map(read).collect()
}
