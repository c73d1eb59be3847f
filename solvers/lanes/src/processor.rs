//! Instruction sets of this processor, and loops compiled for them.

use crate::{FourLanes, LANES, Lanes, ScalarBackend};
use std::sync::OnceLock;

/// Environment variable that forces an instruction set: `portable`, `avx2` or `avx512`.
pub const PROCESSOR: &str = "GRAINBENCH_PROCESSOR";

/// Loop that processes as many items at a time as a register of the backend holds.
pub trait Kernel {
    /// Result of the loop.
    type Output;
    /// Runs the loop.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Loop over four items at a time.
pub trait FourKernel {
    /// Runs the loop.
    fn run<L: FourLanes>(self, lanes: L);
}

/// Instruction set for which loops are compiled.
#[derive(Clone, Copy, Debug)]
pub enum Processor {
    /// Portable code for every processor.
    Portable,
    /// 256-bit registers (x86-64-v3).
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    /// 512-bit registers (x86-64-v4).
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
}

impl Default for Processor {
    fn default() -> Self {
        Self::new()
    }
}

impl Processor {
    /// Returns the instruction set forced by the environment, or the best one of this processor.
    #[must_use]
    pub fn new() -> Self {
        static CHOSEN: OnceLock<Processor> = OnceLock::new();
        *CHOSEN.get_or_init(|| Self::forced().ok().flatten().unwrap_or_else(Self::best))
    }

    /// Returns the best instruction set of this processor.
    #[must_use]
    pub fn best() -> Self {
        Self::all().pop().unwrap_or(Self::Portable)
    }

    /// Returns every instruction set of this processor, the best one last.
    #[must_use]
    pub fn all() -> Vec<Self> {
        #[cfg(target_arch = "x86_64")]
        let wider = [pulp::x86::V3::try_new().map(Self::Avx2), pulp::x86::V4::try_new().map(Self::Avx512)];
        #[cfg(not(target_arch = "x86_64"))]
        let wider = [None];
        std::iter::once(Self::Portable).chain(wider.into_iter().flatten()).collect()
    }

    /// Returns the instruction set forced by the environment; `None` if there is none.
    ///
    /// # Errors
    /// When the environment names an unknown instruction set, or one that this processor lacks.
    pub fn forced() -> Result<Option<Self>, String> {
        let Some(name) = std::env::var_os(PROCESSOR) else { return Ok(None) };
        let all = Self::all();
        let names: Vec<String> = all.iter().map(|path| format!("`{}`", path.name())).collect();
        let found = all.into_iter().find(|path| path.name() == name);
        let expected = || format!("expected one that this processor has ({})", names.join(", "));
        found.map(Some).ok_or_else(|| format!("{PROCESSOR}: {}, found `{}`", expected(), name.to_string_lossy()))
    }

    /// Returns the name that `GRAINBENCH_PROCESSOR` accepts.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "avx512",
        }
    }

    /// Runs a loop over as many items at a time as a register holds.
    #[inline(always)]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Portable => portable(|lanes| kernel.run(lanes)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(features) => features.vectorize(
                #[inline(always)]
                move || kernel.run(features),
            ),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(features) => features.vectorize(
                #[inline(always)]
                move || kernel.run(features),
            ),
        }
    }

    /// Runs a loop over four items at a time.
    #[inline(always)]
    pub fn run_by_four<K: FourKernel>(self, kernel: K) {
        match self {
            Self::Portable => portable(|lanes| kernel.run(lanes)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(features) => features.vectorize(
                #[inline(always)]
                move || kernel.run(features),
            ),
            // Four lanes are used here too, but the loop has the larger number of registers of AVX-512.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(features) => features.vectorize(
                #[inline(always)]
                move || kernel.run(*features),
            ),
        }
    }
}

/// Runs a loop in portable code. It is a separate function, like the functions for other instruction sets. With many
/// such loops in one function, compilation takes minutes.
#[inline(never)]
fn portable<R>(run: impl FnOnce(ScalarBackend<LANES>) -> R) -> R {
    run(ScalarBackend)
}
