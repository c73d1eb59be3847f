//! Scene of a command, from a case or from a file.

use super::exit::{self, Fault, refuse};
use super::names::variants;
use grainbench::adapt::{AdaptedScene, adapted};
use grainbench::cases::folder;
use grainbench::cases::registry::CASES;
use grainbench::harness::case::{Case, PLAIN};
use grainbench::harness::claim::Claim;
use grainbench::scene::scene::Scene;
use grainbench::scene::source::SceneSource;
use grainbench::solver::resolution::Resolution;
use std::path::Path;

/// Case and, optionally, a variant of it.
#[derive(Clone, Copy)]
pub(crate) struct Variant<'a> {
    pub(crate) case: &'static Case,
    /// Name of the variant. `None` means the plain scene or, in [`exact_scene`], any variant.
    pub(crate) variant: Option<&'a str>,
}

impl<'a> Variant<'a> {
    /// Reads `CASE`, `CASE/VARIANT`, or the path of the folder of a case, with or without `/VARIANT`.
    pub(crate) fn read_with_folders(text: &'a str) -> Result<Self, Fault> {
        let is_folder = |path: &str| Path::new(path).join(folder::CLAIMS).is_file();
        if CASES.iter().any(|case| text.split('/').next() == Some(case.name)) {
            if is_folder(text) {
                let message = format!("`{text}` selects the built-in case; write ./{text} to select the folder");
                exit::say("warning", &message);
            }
            return Self::read(text);
        }
        if Path::new(text).is_dir() {
            return Ok(Self { case: folder::read(Path::new(text))?, variant: None });
        }
        match text.rsplit_once('/').filter(|(folder, _)| is_folder(folder)) {
            Some((folder, variant)) => Self::of_case(folder::read(Path::new(folder))?, Some(variant)),
            None => Self::read(text),
        }
    }

    /// Reads `CASE` or `CASE/VARIANT`.
    pub(crate) fn read(text: &'a str) -> Result<Self, Fault> {
        let (name, variant) = text.split_once('/').map_or((text, None), |(name, variant)| (name, Some(variant)));
        let case = CASES
            .iter()
            .find(|case| case.name == name)
            .ok_or_else(|| Fault::unknown("a case", name, CASES.iter().map(|case| case.name)))?;
        Self::of_case(case, variant)
    }

    /// Checks that a case has a variant.
    fn of_case(case: &'static Case, variant: Option<&'a str>) -> Result<Self, Fault> {
        if let Some(variant) = variant {
            let known = variants(case, &(case.claims)())?;
            if variant != PLAIN && !known.iter().any(|name| name == variant) {
                let what = format!("a variant of {}", case.name);
                return Err(Fault::unknown(&what, variant, known.iter().map(String::as_str)));
            }
        }
        Ok(Self { case, variant })
    }

    /// Returns the source text of the scene.
    fn source(&self) -> SceneSource {
        match self.variant {
            None | Some(PLAIN) => self.case.source(),
            Some(variant) => self.case.source().variant(variant),
        }
    }
}

/// Variants of a case that the user names; none stands for all variants.
#[derive(Default)]
pub(crate) struct SelectedVariants<'a>(Vec<Option<&'a str>>);

impl<'a> SelectedVariants<'a> {
    /// Returns true if a variant is selected. Without names, all variants are.
    pub(crate) fn contain(&self, variant: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|named| named.is_none_or(|name| name == variant))
    }

    /// Returns the variants that are named.
    pub(crate) fn named(&self) -> impl Iterator<Item = &'a str> {
        self.0.iter().copied().flatten()
    }
}

/// Returns the cases that `CASE` and `CASE/VARIANT` name, in the order of the registry; all cases if there are no names.
pub(crate) fn selected(names: &[String]) -> Result<Vec<(&'static Case, SelectedVariants<'_>)>, Fault> {
    names.iter().map(|name| Variant::read(name)).collect::<Result<Vec<_>, _>>().map(|named| by_case(&named))
}

/// Returns the named cases with their variants: cases of the registry in its order, then folders. Without names, returns
/// all cases of the registry.
pub(crate) fn by_case<'a>(named: &[Variant<'a>]) -> Vec<(&'static Case, SelectedVariants<'a>)> {
    let is_of_registry = |case: &&'static Case| CASES.iter().any(|known| std::ptr::eq(*known, *case));
    let folders = named.iter().map(|named| named.case).filter(|case| !is_of_registry(case));
    let of_case = |case: &'static Case| {
        let mine = named.iter().filter(|named| std::ptr::eq(named.case, case));
        let variants: Vec<Option<&str>> = mine.map(|named| named.variant).collect();
        (named.is_empty() || !variants.is_empty()).then_some((case, SelectedVariants(variants)))
    };
    CASES.iter().copied().chain(folders).filter_map(of_case).collect()
}

/// Returns true if a text names a scene file.
pub(crate) fn is_scene_file(text: &str) -> bool {
    Path::new(text).extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"))
}

/// Reads the scene of `CASE`, `CASE/VARIANT`, the folder of a case or a file with the extension `.toml`. Overrides the
/// keys in `set`, and the keys that follow from them.
pub(crate) fn adapted_scene(
    text: &str,
    set: &[(String, String)],
) -> Result<(AdaptedScene, Option<&'static Case>), Fault> {
    if is_scene_file(text) {
        return Ok((adapted(&SceneSource::read(Path::new(text))?, set)?, None));
    }
    let variant = Variant::read_with_folders(text)?;
    Ok((adapted(&variant.source(), set)?, Some(variant.case)))
}

/// Reads a scene as [`adapted_scene`] does, and reports the keys that follow from the keys in `set`.
pub(crate) fn scene(text: &str, set: &[(String, String)]) -> Result<(Scene, Option<&'static Case>), Fault> {
    let (AdaptedScene { scene, implied, .. }, case) = adapted_scene(text, set)?;
    tell_implied(&implied);
    Ok((scene, case))
}

/// Reports the keys that follow from the overridden keys.
pub(crate) fn tell_implied(implied: &[(String, String)]) {
    let key = |(key, value): &(String, String)| {
        if value.is_empty() { format!("no {key}") } else { format!("{key} = {value}") }
    };
    if !implied.is_empty() {
        exit::say("note", &format!("--set implies {}", implied.iter().map(key).collect::<Vec<_>>().join(", ")));
    }
}

/// Returns the scene and the resolution of the first solver-independent claim of a case or variant.
pub(crate) fn exact_scene(text: &str) -> Result<(Scene, Resolution), Fault> {
    let named = Variant::read_with_folders(text)?;
    let fair = |claim: &Claim| claim.scope.is_of_grains() && claim.runs.len() == 1;
    let run = (named.case.claims)()
        .into_iter()
        .filter(fair)
        .filter_map(|claim| claim.runs.into_iter().next())
        .filter(|run| named.variant.is_none_or(|variant| variant == run.variant));
    // Claims with a time step come first, because an input deck cannot use the cells of a grid.
    let run =
        run.min_by_key(|run| !matches!(run.resolution, Resolution::TimeStep(_) | Resolution::CriticalFraction(_)));
    let Some(run) = run else {
        refuse!("expected a case with a solver-independent claim, found `{text}`");
    };
    let mut scene = named.case.variant(run.variant)?;
    if let Some((_, change)) = &run.adjustment {
        change(&mut scene);
    }
    Ok((scene, run.resolution))
}
