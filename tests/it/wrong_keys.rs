//! Sets each key of the scene schema to a value of a wrong type. Each error names the file, the line, the key and the
//! expected type. Boolean keys accept `true`. Keys below `variants` are skipped.

use grainbench::cases::registry::read_grains;
use grainbench::scene::source::SceneSource;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

/// Values that are wrong for every key, except `true` for Boolean keys.
const WRONG: [&str; 3] = ["{ wrong = 1 }", "[[\"wrong\"]]", "true"];

/// Returns the paths of all keys of the schema. `x` represents names that the user chooses.
fn keys(schema: &Value) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    walk(schema, schema, "", 0, &mut found);
    found
}

fn walk(schema: &Value, at: &Value, path: &str, depth: usize, found: &mut BTreeSet<String>) {
    assert!(depth < 40, "{path}: a circle");
    if let Some(name) = at.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/")) {
        walk(schema, &schema["$defs"][name], path, depth + 1, found);
    }
    for one in ["anyOf", "oneOf", "allOf"].into_iter().filter_map(|key| at.get(key)?.as_array()).flatten() {
        walk(schema, one, path, depth + 1, found);
    }
    for (key, subschema) in at.get("properties").and_then(Value::as_object).into_iter().flatten() {
        // A variant may contain any key of a scene, so its keys are skipped.
        if key == "variants" {
            continue;
        }
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        walk(schema, subschema, &path, depth + 1, found);
        found.insert(path);
    }
    if let Some(subschema) = at.get("additionalProperties").filter(|subschema| subschema.is_object()) {
        walk(schema, subschema, &format!("{path}.x"), depth + 1, found);
        found.insert(format!("{path}.x"));
    }
}

/// Returns the error of a scene that begins with an additional line; `None` if the scene is valid.
fn answer(line: &str) -> Option<String> {
    let rest = "title = \"One key\"\ndimension = 2\nduration = 1.0\n";
    let key = line.split(' ').next().unwrap_or_default();
    let rest: String =
        rest.lines().filter(|line| line.split(' ').next() != Some(key)).map(|line| format!("{line}\n")).collect();
    let source = SceneSource::from_text("scene.toml", Path::new("."), &format!("{line}\n{rest}"));
    source.scene(&read_grains).err().map(|error| error.to_string())
}

#[test]
fn each_key_given_another_kind_of_value_is_refused_by_a_message_that_helps() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&text).unwrap();
    let keys = keys(&schema);
    assert!(keys.len() > 150, "{}", keys.len());
    let mut messages = String::new();
    for key in &keys {
        writeln!(messages, "{key}").unwrap();
        for value in WRONG {
            let line = format!("{key} = {value}");
            match answer(&line) {
                Some(message) => {
                    assert!(message.contains("scene.toml"), "{line}: {message}");
                    assert!(message.contains("expected"), "{line}: {message}");
                    writeln!(messages, "  {value}: {}", message.replace('\n', "\n  ")).unwrap();
                }
                None => assert_eq!(value, "true", "{line} is taken"),
            }
        }
    }
    insta::assert_snapshot!(messages);
}
