//! Scene with which the output is compared: a case, with or without changed parameters, or a scene file of the user.

use super::error::CheckError;
use crate::adapt::{AdaptedScene, adapted};
use grainbench_harness::case::{Case, PLAIN};
use grainbench_harness::claim::{Claim, ParameterVariation};
use grainbench_harness::tolerance::computed;
use grainbench_reference::observer::Names;
use grainbench_reference::read_start;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;
use std::path::PathBuf;

/// File whose first sample gives sizes, masses and motion of the grains at the start.
#[derive(Clone, Debug)]
pub struct StartFile {
    /// Path of the file.
    pub path: PathBuf,
    /// Names of its columns.
    pub names: Names,
}

/// Scene that the user states for the output.
pub enum DeclaredScene<'s> {
    /// A case with a named variant or, without a name, with the variant that matches the first sample.
    Case {
        /// The case.
        case: &'static Case,
        /// Name of the variant.
        variant: Option<&'s str>,
        /// Changed keys of the scene with their values.
        set: &'s [(String, String)],
        /// File that gives the start of the scene, if any.
        like: Option<StartFile>,
    },
    /// A scene file of the user.
    Scene {
        /// Name of the file without its extension.
        name: String,
        /// The scene with its changed keys.
        scene: Box<Scene>,
        /// The scene without changed keys; `None` if it is incomplete without them.
        own: Option<Box<Scene>>,
        /// Indices of the grains whose positions follow a changed radius.
        moved: Vec<usize>,
    },
}

impl DeclaredScene<'_> {
    /// Returns the case; `None` for a scene file of the user.
    pub(super) const fn case(&self) -> Option<&'static Case> {
        match self {
            Self::Case { case, .. } => Some(case),
            Self::Scene { .. } => None,
        }
    }

    /// Returns the case if none of its parameters is changed, so that its stored runs can be used.
    pub(super) const fn as_stored(&self) -> Option<&'static Case> {
        match self {
            Self::Case { case, set: [], like: None, .. } => Some(case),
            _ => None,
        }
    }

    /// Returns the name of the case or scene.
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

    /// Returns the name of the case or scene, with the variant if one is named.
    pub(super) fn place(&self) -> String {
        match self {
            Self::Case { case, variant: Some(variant), .. } => format!("{}/{variant}", case.name),
            _ => self.name(),
        }
    }

    /// Returns all scenes to which the output may belong.
    pub(super) fn candidates(&self) -> Result<Vec<Candidate>, CheckError> {
        match *self {
            Self::Case { case, variant, set: [], like: None } => Ok(candidates(case, variant)?),
            Self::Case { case, variant, set, ref like } => with_other_numbers(case, variant, set, like.as_ref()),
            Self::Scene { ref scene, ref own, ref moved, .. } => {
                let (scene, own) = ((**scene).clone(), own.as_deref().cloned());
                let moved = moved.clone();
                Ok(vec![Candidate { variant: PLAIN.to_owned(), scene, own, moved, claims: Vec::new() }])
            }
        }
    }
}

/// Scene to which the output may belong.
pub(super) struct Candidate {
    pub(super) variant: String,
    pub(super) scene: Scene,
    /// The scene without changed keys. Its sampling interval determines the longest accepted interval between samples.
    pub(super) own: Option<Scene>,
    /// Indices of the grains whose positions follow a changed radius.
    pub(super) moved: Vec<usize>,
    /// Claims about this scene.
    pub(super) claims: Vec<Claim>,
}

impl Candidate {
    /// Returns a scene without changed keys and without claims.
    fn new(variant: String, scene: Scene) -> Self {
        Self { variant, own: Some(scene.clone()), scene, moved: Vec::new(), claims: Vec::new() }
    }
}

/// Returns the scenes of a case, and these scenes as changed by solver-independent claims.
fn candidates(case: &'static Case, variant: Option<&str>) -> Result<Vec<Candidate>, SceneError> {
    let mut names = case.variants()?;
    if !names.iter().any(|name| name == PLAIN) {
        names.push(PLAIN.to_owned());
    }
    names.retain(|name| variant.is_none_or(|variant| variant == name));
    let candidate = |name: String| case.variant(&name).map(|scene| Candidate::new(name, scene));
    let mut candidates = names.into_iter().map(candidate).collect::<Result<Vec<_>, _>>()?;
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
            None => candidates.push(Candidate { claims: vec![claim], ..Candidate::new(variant, scene) }),
        }
    }
    Ok(candidates)
}

/// Returns the scenes of a case with changed parameters, and the claims whose tolerance can be computed for them.
fn with_other_numbers(
    case: &'static Case,
    variant: Option<&str>,
    set: &[(String, String)],
    like: Option<&StartFile>,
) -> Result<Vec<Candidate>, CheckError> {
    let mut names = case.variants()?;
    names.retain(|name| variant.is_none_or(|variant| variant == name));
    let candidate = |name: String| {
        let source = if name == PLAIN { case.source() } else { case.source().variant(&name) };
        let AdaptedScene { mut scene, moved, .. } = adapted(&source, set)?;
        if let Some(StartFile { path, names }) = like {
            read_start(path, names, &mut scene)?;
        }
        let claims =
            (case.claims)().into_iter().filter(|claim| matches!(&claim.runs[..], [run] if run.variant == name));
        let claims = claims.filter_map(|claim| elsewhere(claim, &scene)).collect();
        Ok(Candidate { own: Some(case.variant(&name)?), variant: name, scene, moved, claims })
    };
    names.into_iter().map(candidate).collect()
}

/// Returns a claim for a scene with other parameters; `None` if its tolerance for this scene is unknown.
fn elsewhere(mut claim: Claim, scene: &Scene) -> Option<Claim> {
    let ParameterVariation { quantity, allowed, because } = claim.elsewhere.take()?;
    let allowed = allowed(scene);
    let is_known = claim.scope.is_of_grains() && allowed.is_finite();
    is_known.then(|| Claim { quantity: quantity.to_owned(), tolerance: computed(allowed, because), ..claim })
}
