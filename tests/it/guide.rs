//! Test of the guide: its commands run, its scenes are simulated, and its links are valid.
//!
//! `UPDATE_README=1 cargo test --release --test it guide` writes its tables again. A `console` block is a dialogue that
//! the shell runs in `guide/scenes`. The output of a command must contain the lines that the block shows, with `…` for
//! varying text. The exit code must be 0, or `N` after `# exit N`. `<!-- needs lmp -->` before a block names programs;
//! without them the block is skipped, except if `CI` is set.

mod dialogue;
mod pages;

use crate::common::{expect_file, is_here, root, table, with_generated};
use dialogue::{Place, blocks, hold};
use grainbench::cases::registry::CASES;
use grainbench::harness::case::Case;
use grainbench::harness::evidence::Evidence;
use grainbench::harness::run::ExpectedOutcome;
use grainbench::harness::verdict::Outcome;
use pages::{Chapter, chapters, lost_links, untold, with_files};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

/// Runs the dialogues of a chapter in order in a separate folder, and returns descriptions of those that failed.
fn lost_dialogues(chapter: &Chapter) -> Vec<String> {
    let place = Place::new();
    let mut lost = Vec::new();
    for block in blocks(&chapter.text).unwrap_or_else(|error| panic!("{}: {error}", chapter.name)) {
        if !block.needs.iter().all(|program| is_here(program)) {
            continue;
        }
        for step in &block.steps {
            if let Err(error) = place.run(step) {
                lost.push(format!("guide/src/{}:{}: {error}", chapter.name, step.line));
            }
        }
    }
    lost
}

#[test]
fn commands_answer_what_the_guide_shows() {
    let mut chapters = chapters();
    let readme = fs::read_to_string(root("README.md")).unwrap().replace("cargo run --release --", "grainbench");
    chapters.push(Chapter { name: "../../README.md".to_owned(), text: readme });
    let lost: Vec<String> = std::thread::scope(|scope| {
        let runs: Vec<_> = chapters.iter().map(|chapter| scope.spawn(|| lost_dialogues(chapter))).collect();
        runs.into_iter().flat_map(|run| run.join().unwrap()).collect()
    });
    assert!(lost.is_empty(), "{}", lost.join("\n\n"));
}

/// Dialogues with wrong output fail: another number, another exit code, a missing line, or another order.
#[test]
fn a_wrong_dialogue_is_refused() {
    let place = Place::new();
    let tried = |shown: &str| {
        let text = format!("```console\n{shown}\n```\n");
        blocks(&text)?.iter().flat_map(|block| &block.steps).try_for_each(|step| place.run(step))
    };
    let right = [
        "$ grainbench simulate belt.toml --solver dem --out belt",
        "scene      A disc is set down on a belt",
        "…",
        "steps      …",
    ];
    let right = right.join("\n");
    assert_eq!(tried(&right), Ok(()));
    for (from, to) in [
        ("A disc is", "A sphere is"),
        ("simulate belt", "simulate bellt"),
        ("…\nsteps      …", "…\nsteps      … hours"),
        ("scene      A disc is set down on a belt\n…\nsteps      …", "steps      …\n…\nscene      …"),
        ("belt\n…\nsteps", "belt\nsteps"),
        ("steps      …", "steps      …\n# exit 1"),
    ] {
        assert!(right.contains(from));
        assert!(tried(&right.replace(from, to)).is_err(), "`{to}` instead of `{from}` is accepted");
    }
    let wrong = "$ grainbench run sqash\nerror: …\n# exit 2";
    assert_eq!(tried(wrong), Ok(()));
    assert!(tried(&wrong.replace("\n# exit 2", "")).is_err(), "an error is no success");
    assert!(blocks("```console\nscene\n```\n").is_err(), "an answer needs a command");
    assert!(blocks("```console\n$ true\n").is_err(), "a block that does not end");
}

#[test]
fn shown_lines_hold_as_they_are_written() {
    assert!(hold("a …, …c", "a 1, b, c") && !hold("a …, …c", "a 1, b, cd") && !hold("ab", "a") && !hold("…b…", "a"));
}

/// Each file in these folders of the guide is shown in a chapter, and each scene is simulated there.
#[test]
fn every_scene_is_in_a_chapter_that_runs_it() {
    let chapters = chapters();
    assert_eq!(untold(&chapters), Vec::<String>::new());
    let without: Vec<Chapter> = chapters.into_iter().filter(|chapter| chapter.name != "scene.md").collect();
    assert!(untold(&without).iter().any(|file| file.contains("hopper.toml")), "a scene that no chapter has is seen");
}

#[test]
fn links_and_includes_lead_somewhere() {
    let chapters = chapters();
    assert_eq!(lost_links(&chapters), Vec::<String>::new());
    for (planted, seen) in [
        ("[there](nowhere.md)", "nowhere.md"),
        ("[there](case.md#nowhere)", "#nowhere"),
        ("{{#include ../scenes/nowhere.toml}}", "nowhere.toml"),
        ("{{#include ../../peers/README.md:nowhere}}", "nowhere"),
        ("```consol\n$ true\n```", "consol"),
    ] {
        let mut wrong = chapters.clone();
        wrong[0].text.push_str(&format!("\n{planted}\n"));
        assert!(lost_links(&wrong).iter().any(|lost| lost.contains(seen)), "{planted} is taken");
    }
    let mut longer = chapters;
    longer.push(Chapter { name: "unknown.md".to_owned(), text: "# Unknown\n".to_owned() });
    assert!(lost_links(&longer).iter().any(|lost| lost.contains("unknown.md")), "a chapter that SUMMARY.md lacks");
}

/// Returns a table with the limitations of each case.
fn weak_table() -> String {
    let row = |case: &&Case| format!("`{}` | {} | {}", case.name, case.title, one_line(case.weakness));
    table("case | title | limitations", CASES.iter().map(row))
}

/// Returns a table of the known errors of solvers. Their results are amber as long as the errors exist.
fn known_table() -> String {
    let mut known: BTreeMap<(&str, &str), Vec<String>> = BTreeMap::new();
    for case in CASES {
        for claim in (case.claims)() {
            for run in &claim.runs {
                if let ExpectedOutcome::Known(reason) = run.standing {
                    let seen = format!("`{}`: {}", case.name, claim.quantity);
                    let rows = known.entry((run.solver, reason)).or_default();
                    if !rows.contains(&seen) {
                        rows.push(seen);
                    }
                }
            }
        }
    }
    let row = |((solver, reason), rows): ((&str, &str), Vec<String>)| {
        format!("`{solver}` | {} | {}", one_line(reason), one_line(&rows.join("; ")))
    };
    table("solver | error | claims that show it", known.into_iter().map(row))
}

/// Returns a text on one line, for a table cell.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

#[test]
fn tables_are_generated() {
    for (path, mark, table) in
        [("guide/src/weak.md", "weak", weak_table()), ("guide/src/known.md", "known", known_table())]
    {
        let text = fs::read_to_string(root(path)).unwrap();
        expect_file(path, &with_generated(&text, mark, &table));
    }
}

/// The guide explains every outcome and every kind of evidence.
#[test]
fn the_words_of_a_row_are_explained() {
    let numbers = fs::read_to_string(root("guide/src/numbers.md")).unwrap();
    let outcomes = [
        Outcome::Pass,
        Outcome::Fail,
        Outcome::Known,
        Outcome::Stale,
        Outcome::Outdated,
        Outcome::NoReference,
        Outcome::Unsupported,
        Outcome::NotAvailable,
        Outcome::Broken,
    ];
    let words = outcomes.map(Outcome::word).into_iter().chain(Evidence::ALL.map(Evidence::word));
    for word in words {
        assert!(numbers.contains(&format!("| `{word}` |")), "numbers.md does not explain `{word}`");
    }
}

/// Chapters contain the present text of the files that they show, also for readers that do not expand includes.
#[test]
fn chapters_show_their_files() {
    for chapter in chapters() {
        expect_file(&format!("guide/src/{}", chapter.name), &with_files(&chapter.text).unwrap());
    }
    let shown = with_files("<!-- file: ../scenes/belt.toml -->\n```toml\nother\n```\nend\n").unwrap();
    assert!(shown.contains("A disc is set down on a belt") && !shown.contains("other") && shown.ends_with("end\n"));
    assert!(with_files("<!-- file: ../scenes/nowhere.toml -->\n```toml\n```\n").is_err());
    assert!(with_files("<!-- file: ../scenes/belt.toml -->\n```toml\n").is_err());
}

/// The tables of the guide contain each key of the files that users write. The keys are the fields of the structs that
/// read these files.
#[test]
fn keys_of_files_are_in_the_guide() {
    for (source, chapter, least) in [
        ("cases/src/folder/claims_file.rs", "guide/src/case.md", 30),
        ("jobs/src/sweep/file.rs", "guide/src/campaign.md", 30),
        ("reference/src/outside/manifest.rs", "guide/src/judge.md", 20),
    ] {
        let [source, chapter] = [source, chapter].map(|path| fs::read_to_string(root(path)).unwrap());
        let rows = chapter.lines().filter(|line| line.starts_with("| "));
        let code = rows.flat_map(|row| row.split('`').skip(1).step_by(2));
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '-';
        let shown: BTreeSet<String> =
            code.flat_map(|text| text.split(|letter| !is_part(letter))).map(|word| word.replace('-', "_")).collect();
        let structs = source.split("impl Manifest ").next().unwrap().lines();
        let public = |line| str::strip_prefix(line, "    pub ").or_else(|| str::strip_prefix(line, "    pub(super) "));
        let fields = structs.filter_map(|line| public(line)?.split_once(": "));
        let keys: Vec<&str> = fields.map(|(name, _)| name).filter(|name| !name.contains(' ')).collect();
        let lost: Vec<&&str> = keys.iter().filter(|key| !shown.contains(**key)).collect();
        assert!(lost.is_empty() && keys.len() >= least, "{lost:?} of {} keys are not in the guide", keys.len());
    }
}
