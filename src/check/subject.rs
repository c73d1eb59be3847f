//! What outputs may be of: a case with its own numbers or with others, or a scene that is no case.

use grainbench_harness::case::{Case, PLAIN};
use grainbench_harness::claim::{Claim, Elsewhere};
use grainbench_harness::tolerance::computed;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;

/// What outputs are said to be of.
pub enum Subject<'s> {
    /// A case: one variant of it, or whichever they start as.
    Case {
        /// The case.
        case: &'static Case,
        /// The variant.
        variant: Option<&'s str>,
        /// Keys of the scene that have other values, with those.
        set: &'s [(String, String)],
    },
    /// A scene of the user's own, by a name.
    Scene {
        /// The name.
        name: String,
        /// The scene.
        scene: Box<Scene>,
    },
}

impl Subject<'_> {
    /// The case, where it is one.
    pub(super) const fn case(&self) -> Option<&'static Case> {
        match self {
            Self::Case { case, .. } => Some(case),
            Self::Scene { .. } => None,
        }
    }

    /// The case, where its numbers are its own, as those of stored runs are.
    pub(super) const fn as_stored(&self) -> Option<&'static Case> {
        match self {
            Self::Case { case, set: [], .. } => Some(case),
            _ => None,
        }
    }

    /// Its name.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Case { case, .. } => case.name.to_owned(),
            Self::Scene { name, .. } => name.clone(),
        }
    }

    pub(super) fn title(&self) -> String {
        match self {
            Self::Case { case, .. } => case.title.to_owned(),
            Self::Scene { scene, .. } => scene.title.clone(),
        }
    }

    /// The name with that of the variant, where one was named.
    pub(super) fn place(&self) -> String {
        match self {
            Self::Case { case, variant: Some(variant), .. } => format!("{}/{variant}", case.name),
            _ => self.name(),
        }
    }

    /// The scenes that outputs may be of.
    pub(super) fn candidates(&self) -> Result<Vec<Candidate>, SceneError> {
        match *self {
            Self::Case { case, variant, set: [] } => candidates(case, variant),
            Self::Case { case, variant, set } => with_other_numbers(case, variant, set),
            Self::Scene { ref scene, .. } => {
                Ok(vec![Candidate { variant: PLAIN.to_owned(), scene: (**scene).clone(), claims: Vec::new() }])
            }
        }
    }
}

/// A scene that the outputs may be of.
pub(super) struct Candidate {
    pub(super) variant: String,
    pub(super) scene: Scene,
    /// The gates whose scene it is.
    pub(super) claims: Vec<Claim>,
}

/// The scenes as they stand, and those that gates fair to any solver adjust.
fn candidates(case: &'static Case, variant: Option<&str>) -> Result<Vec<Candidate>, SceneError> {
    let mut names = case.variants()?;
    if !names.iter().any(|name| name == PLAIN) {
        names.push(PLAIN.to_owned());
    }
    names.retain(|name| variant.is_none_or(|variant| variant == name));
    let mut candidates: Vec<Candidate> = Vec::new();
    for name in names {
        candidates.push(Candidate { scene: case.variant(&name)?, variant: name, claims: Vec::new() });
    }
    for claim in (case.claims)() {
        let [run] = &claim.runs[..] else { continue };
        if !claim.scope.is_of_grains() || variant.is_some_and(|variant| variant != run.variant) {
            continue;
        }
        let mut scene = case.variant(run.variant)?;
        if let Some((_, change)) = &run.adjustment {
            change(&mut scene);
        }
        let variant = run.variant.to_owned();
        match candidates.iter_mut().find(|other| other.variant == variant && other.scene == scene) {
            Some(candidate) => candidate.claims.push(claim),
            None => candidates.push(Candidate { variant, scene, claims: vec![claim] }),
        }
    }
    Ok(candidates)
}

/// The scenes with keys that have other values, and the claims whose tolerance follows the scene.
fn with_other_numbers(
    case: &'static Case,
    variant: Option<&str>,
    set: &[(String, String)],
) -> Result<Vec<Candidate>, SceneError> {
    let mut names = case.variants()?;
    names.retain(|name| variant.is_none_or(|variant| variant == name));
    let candidate = |name: String| {
        let source = if name == PLAIN { case.source() } else { case.source().variant(&name) };
        let source = set.iter().fold(source, |source, (path, value)| source.set(path, value));
        let scene = source.scene(&case.home.read_grains)?;
        let claims =
            (case.claims)().into_iter().filter(|claim| matches!(&claim.runs[..], [run] if run.variant == name));
        let claims = claims.filter_map(|claim| elsewhere(claim, &scene)).collect();
        Ok(Candidate { variant: name, scene, claims })
    };
    names.into_iter().map(candidate).collect()
}

/// A claim as it holds of another scene of its kind; none where that is not known.
fn elsewhere(mut claim: Claim, scene: &Scene) -> Option<Claim> {
    let Elsewhere { quantity, allowed, because } = claim.elsewhere.take()?;
    let allowed = allowed(scene);
    let is_known = claim.scope.is_of_grains() && allowed.is_finite();
    is_known.then(|| Claim { quantity: quantity.to_owned(), tolerance: computed(allowed, because), ..claim })
}
