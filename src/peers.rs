//! Programs of `peers/`, as they were judged when somebody ran them.

use grainbench_reports::judged::Judged;

/// What is kept of each, by its folder.
pub const KEPT: [(&str, &str); 5] = [
    ("yade", include_str!("../peers/yade/judged.json")),
    ("kratos-dem", include_str!("../peers/kratos-dem/judged.json")),
    ("lammps", include_str!("../peers/lammps/judged.json")),
    ("taichi", include_str!("../peers/taichi/judged.json")),
    ("kratos-mpm", include_str!("../peers/kratos-mpm/judged.json")),
];

/// The programs that were judged before.
///
/// # Errors
/// Names the file that is not what was kept.
pub fn kept() -> Result<Vec<Judged>, String> {
    let read =
        |(name, text): (&str, &str)| Judged::read(text).map_err(|error| format!("peers/{name}/judged.json: {error}"));
    KEPT.into_iter().map(read).collect()
}
