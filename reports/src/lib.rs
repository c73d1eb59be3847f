//! Placeholder.
pub fn failure_line(verdict: &grainbench_cases::verdict::Verdict) -> String {
    format!("{verdict:?}")
}
