//! One grain on planes: linear springs with dashpots and Coulomb friction, by the leap-frog scheme of Cundall and Strack.
//! Only the standard library is used, so `rustc` compiles the file without Cargo.

use std::array::from_fn;
use std::fmt::Write;
use std::{env, fs, process};

type Vector = [f64; 3];

/// Returns a + factor b.
fn plus(a: Vector, b: Vector, factor: f64) -> Vector {
    from_fn(|axis| a[axis] + factor * b[axis])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Reads the `N` numbers after a key, from the start of the text. This is enough JSON for the scene.
fn numbers<const N: usize>(text: &str, key: &str) -> [f64; N] {
    let start = text.find(&format!("\"{key}\":")).unwrap_or_else(|| panic!("the scene has no key `{key}`"));
    let values =
        text[start + key.len() + 3..].split(['[', ',', ']', '}']).map(str::trim).filter(|word| !word.is_empty());
    let mut values = values.map(|word| word.parse().unwrap_or_else(|_| panic!("`{key}`: `{word}` is no number")));
    from_fn(|_| values.next().unwrap_or_else(|| panic!("`{key}` has too few numbers")))
}

struct Wall {
    point: Vector,
    normal: Vector,
    spring: Vector,
}

fn main() {
    let words: Vec<String> = env::args().collect();
    let text = fs::read_to_string(&words[1]).expect("the scene can be read");
    if text.contains("\"id\":2") {
        println!("it moves one grain");
        process::exit(64);
    }
    let number = |key: &str| numbers::<1>(&text, key)[0];
    let (mass, radius, inertia) = (number("mass"), number("radius"), number("inertia"));
    let (dt, count, every) = (number("time_step"), number("count") as u64, number("sample_every") as u64);
    let laws = text.find("\"laws\"").expect("the scene has laws");
    let (beta, friction_coefficient) = (number("stiffness_damping"), numbers::<1>(&text[laws..], "friction")[0]);
    let stiffness = [number("normal_stiffness"), number("tangential_stiffness")];
    let dashpot = [
        number("normal_damping") * mass + beta * stiffness[0],
        number("tangential_damping") * mass + beta * stiffness[1],
    ];
    let gravity: Vector = numbers(&text, "gravity");
    let (mut x, mut v, mut spin): (Vector, Vector, Vector) =
        (numbers(&text, "position"), numbers(&text, "velocity"), numbers(&text, "spin"));
    let wall = |(at, _): (usize, &str)| Wall {
        point: numbers(&text[at..], "point"),
        normal: numbers(&text[at..], "normal"),
        spring: [0.0; 3],
    };
    let mut walls: Vec<Wall> = text.match_indices("\"plane\":").map(wall).collect();

    let mut loads = |x: Vector, v: Vector, spin: Vector, step: f64| {
        let (mut force, mut torque) = (plus([0.0; 3], gravity, mass), [0.0; 3]);
        for wall in &mut walls {
            let n = wall.normal;
            let overlap = radius - dot(plus(x, wall.point, -1.0), n);
            if overlap <= 0.0 {
                wall.spring = [0.0; 3];
                continue;
            }
            let arm = plus([0.0; 3], n, -radius);
            let slip = plus(v, cross(spin, arm), 1.0);
            let slip = plus(slip, n, -dot(slip, n));
            let push = stiffness[0] * overlap - dashpot[0] * dot(v, n);
            let drag = plus([0.0; 3], slip, dashpot[1]);
            wall.spring = plus(wall.spring, slip, stiffness[1] * step);
            let mut friction = plus(plus([0.0; 3], wall.spring, -1.0), drag, -1.0);
            let (size, limit) = (dot(friction, friction).sqrt(), friction_coefficient * push.max(0.0));
            if size > limit {
                friction = plus([0.0; 3], friction, limit / size);
                wall.spring = plus(plus([0.0; 3], friction, -1.0), drag, -1.0);
            }
            force = plus(plus(force, n, push), friction, 1.0);
            torque = plus(torque, cross(arm, friction), 1.0);
        }
        (plus([0.0; 3], force, dt / mass / 2.0), plus([0.0; 3], torque, dt / inertia / 2.0))
    };
    let mut table = "step,id,x,y,z,vx,vy,vz,omegax,omegay,omegaz\n".to_owned();
    let (mut kick, mut turn) = loads(x, v, spin, 0.0);
    for step in 0..=count {
        if step % every == 0 || step == count {
            table += &format!("{step},1");
            for value in [x, v, spin].concat() {
                write!(table, ",{value:e}").expect("a text can grow");
            }
            table.push('\n');
        }
        (v, spin) = (plus(v, kick, 1.0), plus(spin, turn, 1.0));
        x = plus(x, v, dt);
        (kick, turn) = loads(x, v, spin, dt);
        (v, spin) = (plus(v, kick, 1.0), plus(spin, turn, 1.0));
    }
    fs::write(format!("{}/grains.csv", words[2]), table).expect("the table can be written");
}
