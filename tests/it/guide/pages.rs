//! Chapters of the guide, with their included files and links.

use crate::common::{entries, root};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Clone)]
pub(crate) struct Chapter {
    pub(crate) name: String,
    pub(crate) text: String,
}

/// Returns all chapters, sorted by name.
pub(crate) fn chapters() -> Vec<Chapter> {
    let files = entries(root("guide/src")).into_iter().filter(|path| path.extension().is_some_and(|end| end == "md"));
    let read = |path: PathBuf| Chapter {
        name: path.file_name().unwrap().to_str().unwrap().to_owned(),
        text: fs::read_to_string(path).unwrap(),
    };
    let found: Vec<Chapter> = files.map(read).filter(|chapter| chapter.name != "SUMMARY.md").collect();
    assert!(found.len() > 7, "{} chapters", found.len());
    found
}

/// Returns the text of a file, or the part of it between two mdBook anchors.
fn included(path: &str) -> Result<String, String> {
    let (path, anchor) = path.split_once(':').map_or((path, None), |(path, anchor)| (path, Some(anchor)));
    let file = root("guide/src").join(path);
    let text = fs::read_to_string(&file).map_err(|error| format!("{path}: {error}"))?;
    let Some(anchor) = anchor else { return Ok(text) };
    let at = |mark: String| {
        text.lines().position(|line| line.split_whitespace().collect::<Vec<_>>().join(" ").contains(&mark))
    };
    let start = at(format!("ANCHOR: {anchor}")).ok_or_else(|| format!("{path} has no anchor {anchor}"))?;
    let end = at(format!("ANCHOR_END: {anchor}")).ok_or_else(|| format!("{path} has no end of {anchor}"))?;
    Ok(text.lines().skip(start + 1).take(end.saturating_sub(start + 1)).collect::<Vec<_>>().join("\n"))
}

/// Returns the text of a chapter with all included files inserted.
fn expanded(chapter: &Chapter) -> Result<String, String> {
    let mut found = String::new();
    let mut rest = chapter.text.as_str();
    while let Some(at) = rest.find("{{#include ") {
        let (before, from) = rest.split_at(at);
        let end = from.find("}}").ok_or("an include does not end")?;
        found += before;
        found += included(from["{{#include ".len()..end].trim())?.trim_end();
        rest = &from[end + 2..];
    }
    Ok(found + rest)
}

/// Returns a text in which the block or table after each `<!-- file: PATH -->` is replaced by the file's content. A
/// block ends with its fence, and a table with `<!-- end of file -->`.
pub(crate) fn with_files(text: &str) -> Result<String, String> {
    let (mut found, mut lines) = (Vec::new(), text.lines());
    while let Some(line) = lines.next() {
        found.push(line.to_owned());
        let Some(path) = line.strip_prefix("<!-- file: ").and_then(|rest| rest.strip_suffix(" -->")) else { continue };
        let first = lines.next().ok_or_else(|| format!("{path}: expected a block, found the end"))?;
        let is_block = first.starts_with("```");
        let end = if is_block { "```" } else { "<!-- end of file -->" };
        if is_block {
            found.push(first.to_owned());
        } else {
            found.push(String::new());
        }
        found.extend(included(path)?.trim().lines().map(str::to_owned));
        if !is_block {
            found.push(String::new());
        }
        lines.by_ref().find(|line| *line == end).ok_or_else(|| format!("{path}: expected `{end}`, found the end"))?;
        found.push(end.to_owned());
    }
    Ok(found.join("\n") + "\n")
}

/// Returns the anchor of a heading.
fn slug(heading: &str) -> String {
    let words = heading.trim_start_matches('#').trim().to_lowercase();
    words
        .chars()
        .filter(|c| c.is_alphanumeric() || "-_ ".contains(*c))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// Returns the targets of all links of a text, except those in code.
fn links(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut is_code = false;
    for line in text.lines() {
        is_code ^= line.starts_with("```");
        let plain: String = line.split('`').step_by(2).collect();
        if !is_code {
            found
                .extend(plain.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(to, _)| to.to_owned()));
        }
    }
    found
}

/// Returns descriptions of errors: broken links, missing files, unknown blocks, and chapters that the summary lacks.
pub(crate) fn lost_links(chapters: &[Chapter]) -> Vec<String> {
    const LANGUAGES: [&str; 6] = ["console", "toml", "rust", "python", "cpp", "text"];
    let summary = fs::read_to_string(root("guide/src/SUMMARY.md")).unwrap();
    let listed = links(&summary);
    let mut lost: Vec<String> = chapters
        .iter()
        .filter(|chapter| !listed.contains(&chapter.name))
        .map(|chapter| format!("SUMMARY.md lacks {}", chapter.name))
        .collect();
    let summary = Chapter { name: "SUMMARY.md".to_owned(), text: summary };
    for chapter in chapters.iter().chain([&summary]) {
        let say = |what: String| format!("{}: {what}", chapter.name);
        if let Err(error) = expanded(chapter) {
            lost.push(say(error));
        }
        for link in links(&chapter.text).into_iter().filter(|link| !link.contains("://")) {
            let (to, heading) = link.split_once('#').map_or((link.as_str(), None), |(to, part)| (to, Some(part)));
            let to = if to.is_empty() { &chapter.name } else { to };
            let text = fs::read_to_string(root("guide/src").join(Path::new(to)));
            let has = |part: &str, text: &str| text.lines().any(|line| line.starts_with('#') && slug(line) == part);
            let leads = text.is_ok_and(|text| heading.is_none_or(|part| has(part, &text)));
            if !leads || to.contains('/') {
                lost.push(say(format!("{link} leads nowhere")));
            }
        }
        let fences = chapter.text.lines().filter_map(|line| line.strip_prefix("```")).filter(|word| !word.is_empty());
        lost.extend(fences.filter(|word| !LANGUAGES.contains(word)).map(|word| say(format!("a block of `{word}`"))));
    }
    lost
}

/// Returns the files that no chapter shows, and the scenes that no chapter runs.
pub(crate) fn untold(chapters: &[Chapter]) -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["scenes", "claims"] {
        for entry in fs::read_dir(root("guide").join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let include = format!("<!-- file: ../{folder}/{name} -->");
            let commands = match folder {
                "scenes" => vec![format!("simulate {name} "), format!("cost {name} ")],
                _ => vec![format!("../{folder}/{name}")],
            };
            let runs = |line: &str| line.starts_with("$ ") && commands.iter().any(|command| line.contains(command));
            let is_told = |chapter: &Chapter| {
                let is_run = chapter.text.lines().any(runs);
                chapter.text.contains(&include) && is_run
            };
            if !chapters.iter().any(is_told) {
                found.push(format!("{folder}/{name}"));
            }
        }
    }
    found
}
