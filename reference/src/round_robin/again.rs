//! Silo, drum and deeper beds: common results of LIGGGHTS and MUSEN, rerun from the shared initial states. The spread
//! of two codes is half their difference.

use super::impact::Impact;
use super::tables::{Kind, PublishedTable, Silo};

/// Period of steady flow out of the silo (s).
pub const STEADY: [f64; 2] = [0.5, 3.5];
/// Period of steady flow for the small orifice, whose data end earlier (s).
pub const STEADY_SMALL: [f64; 2] = [0.5, 2.0];
/// Period shortly after the flow has started (s).
pub const EARLY: [f64; 2] = [0.2, 0.8];
/// Codes that are included, by the ending of their table names.
const CODES: [&str; 2] = ["liggghts", "musen"];
/// Times at which grains left in the silo are counted (s).
const LEFT: [f64; 9] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.3];
/// Number of samples and interval (s) of the counts of M1 in zone 2 of the drum.
const MIXED: (usize, f64) = (10, 0.1);

/// Beds with one realization each: thousands of grains, word in table names, time (s) of the height of the ball, and
/// key of the number.
const BEDS: [(usize, &str, f64, &str); 3] = [
    (50, "case3_50k", 0.03, "height_30_50k"),
    (100, "case3_100k", 0.03, "height_30_100k"),
    (100, "case3_100k", 0.06, "height_60_100k"),
];

/// Result of two codes, or of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Mean of the codes.
    pub mean: f64,
    /// Half the difference of the codes, or `None` for a single code.
    pub half: Option<f64>,
}

impl Pair {
    fn from_values(values: &[f64]) -> Option<Self> {
        match values {
            [one] => Some(Self { mean: *one, half: None }),
            [a, b] => Some(Self { mean: 0.5 * (a + b), half: Some(0.5 * (a - b).abs()) }),
            _ => None,
        }
    }
}

/// Derived quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Key in the provenance of the paper, or name of the table for a time series.
    pub key: &'static str,
    /// Description.
    pub what: String,
    /// Time (s) of a point in a time series, or `None` for a single number.
    pub time: Option<f64>,
    /// Value.
    pub pair: Pair,
}

/// Returns the common results of the tables of silo, drum and beds.
#[must_use]
pub fn pairs(tables: &[PublishedTable]) -> Vec<Quantity> {
    let codes = |words: &str| -> Vec<&PublishedTable> {
        let named = |code: &&str| tables.iter().find(|table| is_of(&table.name, words, code));
        CODES.iter().filter_map(named).collect()
    };
    let (large, small, drum) = (codes("large"), codes("small"), codes("case2"));
    let mut all = Vec::new();
    let mut add = |key, what: String, time, published: &[&PublishedTable], read: &dyn Fn(&Kind) -> Option<f64>| {
        let values: Option<Vec<f64>> = published.iter().map(|table| read(&table.kind)).collect();
        if let Some(pair) = values.as_deref().and_then(Pair::from_values) {
            all.push(Quantity { key, what, time, pair });
        }
    };
    let rate = |between: [f64; 2]| move |kind: &Kind| silo(kind)?.rate(between).map(|rate| rate / 1e3);
    let between = |orifice: &str, [from, to]: [f64; 2]| {
        format!("grains out of the {orifice} orifice between {from} and {to} s of flow (thousands a second)")
    };
    add("silo_large_rate", between("large", STEADY), None, &large, &rate(STEADY));
    add("silo_large_early", between("large", EARLY), None, &large, &rate(EARLY));
    add("silo_small_rate", between("small", STEADY_SMALL), None, &small, &rate(STEADY_SMALL));
    let out = "grains out of the large orifice in 2 s (thousands)".to_owned();
    add("silo_large_out_2", out, None, &large, &|kind| Some(1e-3 * (silo(kind)?.at(0.0)? - silo(kind)?.at(2.0)?)));
    for (thousands, words, time, key) in BEDS {
        let what = format!("height of the ball at {} ms, {thousands} thousand grains, one bed (mm)", time * 1e3);
        add(key, what, None, &codes(words), &|kind| impact(kind).and_then(|impact| height(impact, time)));
    }
    for time in LEFT {
        add("silo-large", String::new(), Some(time), &large, &|kind| silo(kind)?.at(time));
    }
    for step in 1..=MIXED.0 {
        let time = step as f64 * MIXED.1;
        let zone = |kind: &Kind| if let Kind::Drum(drum) = kind { drum.in_zone_2(time) } else { None };
        add("drum-zone-2", String::new(), Some(time), &drum, &zone);
    }
    all
}

/// Returns true if the name of a table contains the given words and ends with a code.
fn is_of(name: &str, words: &str, code: &str) -> bool {
    name.contains(words) && name.ends_with(&format!("_{code}"))
}

fn silo(kind: &Kind) -> Option<&Silo> {
    if let Kind::Silo(silo) = kind { Some(silo) } else { None }
}

fn impact(kind: &Kind) -> Option<&Impact> {
    if let Kind::Impact(impact) = kind { Some(impact) } else { None }
}

/// Returns the height of the only ball in a table (mm) at a time (s) since its release. The clock error of the table
/// is corrected.
fn height(impact: &Impact, time: f64) -> Option<f64> {
    let [course] = &impact.courses[..] else { return None };
    impact.height(course, time - impact.ahead(course)).map(|height| height * 1e3)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::super::impact::Course;
    use super::*;

    fn table(name: &str, left: [f64; 3]) -> PublishedTable {
        PublishedTable {
            name: name.to_owned(),
            kind: Kind::Silo(Silo { times: vec![0.0, 2.0, 4.0], left: left.to_vec() }),
        }
    }

    #[test]
    fn two_codes_have_a_mean_and_others_do_not_count() {
        let tables = [
            table("case1_large_M1_liggghts", [100e3, 50e3, 0.0]),
            table("case1_large_M1_musen", [100e3, 52e3, 4e3]),
            table("case1_large_M1_other", [100e3, 0.0, 0.0]),
            table("case1_small_M1_musen", [100e3, 84e3, 68e3]),
        ];
        let all = pairs(&tables);
        let quantity_named =
            |key: &str| all.iter().find(|quantity| quantity.key == key && quantity.time.is_none()).unwrap();
        let rate = &quantity_named("silo_large_rate").pair;
        assert!((rate.mean - 24.5).abs() < 1e-12 && (rate.half.unwrap() - 0.5).abs() < 1e-12, "{rate:?}");
        assert_eq!(quantity_named("silo_small_rate").pair, Pair { mean: 8.0, half: None });
        assert_eq!(quantity_named("silo_large_out_2").pair, Pair { mean: 49.0, half: Some(1.0) });
        let left: Vec<f64> =
            all.iter().filter(|found| found.key == "silo-large").map(|found| found.pair.mean).collect();
        assert_eq!(left[3], 51e3);
        // The table ends before the last of the times.
        assert_eq!(left.len(), 8);
    }

    /// A clock error is corrected. Two time series in one table are not a bed with one realization.
    #[test]
    fn a_ball_is_where_it_is_since_its_release() {
        let flight = |time: f64| 0.06 - 5.0 * time - 0.5 * 9.81 * time * time;
        let fallen = |name: &str, ahead: f64, lower: f64, courses: u32| {
            let times: Vec<f64> = (0..=100).map(|step| 1e-3 * f64::from(step)).collect();
            let heights: Vec<f64> = times.iter().map(|time| flight(time + ahead) - lower * (time + ahead)).collect();
            let course = |bed| Course { code: name.to_owned(), bed, heights: heights.clone() };
            let courses = (1..=courses as usize).map(course).collect();
            PublishedTable { name: name.to_owned(), kind: Kind::Impact(Impact { times, courses, repeated: 0 }) }
        };
        let tables = [
            fallen("case3_100k_liggghts", 5e-5, 0.0, 1),
            fallen("case3_100k_musen", 0.0, 0.1, 1),
            fallen("case3_50k_musen", 0.0, 0.0, 2),
        ];
        let all = pairs(&tables);
        let pair_of = |key: &str| all.iter().find(|quantity| quantity.key == key).map(|quantity| quantity.pair.clone());
        let found = pair_of("height_30_100k").unwrap();
        // The second ball is 3 mm lower. The error of linear interpolation of the parabola is g/8 times the square of
        // 1 ms.
        assert!((found.mean - (1e3 * flight(0.03) - 1.5)).abs() < 2e-3 && (found.half.unwrap() - 1.5).abs() < 2e-3);
        assert_eq!(pair_of("height_30_50k"), None);
    }
}
