//! What this processor has, and loops that are compiled for it.

use crate::{FourLanes, LANES, Lanes, Plain};
use std::sync::OnceLock;

/// The environment variable that forces a path: `portable`, `avx2` or `avx512`.
pub const PROCESSOR: &str = "GRAINBENCH_PROCESSOR";

/// A loop that takes as many at a time as registers hold, or four, or one by one.
pub trait Kernel {
    /// What it leaves.
    type Output;
    /// Runs it.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// A loop that takes four at a time.
pub trait FourKernel {
    /// Runs it.
    fn run<L: FourLanes>(self, lanes: L);
}

/// A path through the loops.
#[derive(Clone, Copy, Debug)]
pub enum Processor {
    /// What every processor can do.
    Portable,
    /// Registers of 256 bits (x86-64-v3).
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    /// Registers of 512 bits (x86-64-v4).
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
}

impl Default for Processor {
    fn default() -> Self {
        Self::new()
    }
}

impl Processor {
    /// The path that the environment forces, else the best that this processor has.
    #[must_use]
    pub fn new() -> Self {
        static CHOSEN: OnceLock<Processor> = OnceLock::new();
        *CHOSEN.get_or_init(|| Self::forced().ok().flatten().unwrap_or_else(Self::best))
    }

    /// The best path that this processor has.
    #[must_use]
    pub fn best() -> Self {
        Self::all().pop().unwrap_or(Self::Portable)
    }

    /// Every path that this processor has, the best last.
    #[must_use]
    pub fn all() -> Vec<Self> {
        #[cfg(target_arch = "x86_64")]
        let wider = [pulp::x86::V3::try_new().map(Self::Avx2), pulp::x86::V4::try_new().map(Self::Avx512)];
        #[cfg(not(target_arch = "x86_64"))]
        let wider = [None];
        std::iter::once(Self::Portable).chain(wider.into_iter().flatten()).collect()
    }

    /// The path that the environment forces.
    ///
    /// # Errors
    /// When it names none, or one that this processor does not have.
    pub fn forced() -> Result<Option<Self>, String> {
        let Some(name) = std::env::var_os(PROCESSOR) else { return Ok(None) };
        let all = Self::all();
        let names: Vec<String> = all.iter().map(|path| format!("`{}`", path.name())).collect();
        let found = all.into_iter().find(|path| path.name() == name);
        let expected = || format!("expected one that this processor has ({})", names.join(", "));
        found.map(Some).ok_or_else(|| format!("{PROCESSOR}: {}, found `{}`", expected(), name.to_string_lossy()))
    }

    /// Its name.
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

    /// Runs a loop over as many at a time as registers hold.
    #[inline(always)]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Portable => portable(kernel),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(features) => pulp::Simd::vectorize(features, Compiled { lanes: features, kernel }),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(features) => pulp::Simd::vectorize(features, Compiled { lanes: features, kernel }),
        }
    }

    /// Runs a loop over four at a time.
    #[inline(always)]
    pub fn run_by_four<K: FourKernel>(self, kernel: K) {
        match self {
            Self::Portable => portable_by_four(kernel),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(features) => pulp::Simd::vectorize(features, CompiledByFour { lanes: features, kernel }),
            // Four lanes as well, but with the more registers that this processor has.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(features) => pulp::Simd::vectorize(features, CompiledByFour { lanes: *features, kernel }),
        }
    }
}

/// A loop, compiled for what every processor can do. It is a function of its own, as those for other processors are: many such
/// loops in one function take the compiler minutes.
#[inline(never)]
fn portable<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(Plain::<LANES>)
}

/// A loop over four at a time, compiled in the same way.
#[inline(never)]
fn portable_by_four<K: FourKernel>(kernel: K) {
    kernel.run(Plain::<LANES>);
}

/// A loop, compiled for a processor.
#[cfg(target_arch = "x86_64")]
struct Compiled<L, K> {
    lanes: L,
    kernel: K,
}

#[cfg(target_arch = "x86_64")]
impl<L: Lanes, K: Kernel> pulp::WithSimd for Compiled<L, K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> K::Output {
        self.kernel.run(self.lanes)
    }
}

/// A loop over four at a time, compiled for a processor.
#[cfg(target_arch = "x86_64")]
struct CompiledByFour<L, K> {
    lanes: L,
    kernel: K,
}

#[cfg(target_arch = "x86_64")]
impl<L: FourLanes, K: FourKernel> pulp::WithSimd for CompiledByFour<L, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.kernel.run(self.lanes);
    }
}
