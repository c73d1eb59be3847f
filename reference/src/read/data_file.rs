//! Data files, which `write_data` writes and `read_data` of LAMMPS and LIGGGHTS reads.

use std::collections::HashMap;
use std::io::BufRead;
use std::mem;
use std::path::Path;

use crate::read::lines::{Fields, Line, Lines, opened};
use crate::read::read_error::{ReadError, quoted};

/// LAMMPS data file with `atom_style sphere`, or LIGGGHTS data file with `atom_style granular`.
#[derive(Debug, Clone, PartialEq)]
pub struct DataFile {
    /// First line, which the programs ignore.
    pub title: String,
    /// Lower and upper corner of the box, in the units of the file.
    pub bounds: ([f64; 3], [f64; 3]),
    /// Grains in the order of the file.
    pub atoms: Vec<Atom>,
}

/// Grain of a LAMMPS data file with `atom_style sphere` or a LIGGGHTS data file with `atom_style granular`.
///
/// Numbers are in the units of the file. A data file does not name its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom {
    /// Id of the grain, at least 1 and unique in its file.
    pub id: u32,
    /// Type of the grain, counted from 1.
    pub type_: u32,
    /// Diameter, positive.
    pub diameter: f64,
    /// Density of a sphere with this diameter, in two dimensions too. See [`Atom::mass`].
    pub density: f64,
    /// Position of the centre, which may be outside the box.
    pub position: [f64; 3],
    /// Number of crossings of each periodic boundary; zero if the file does not contain them.
    pub image: [i32; 3],
    /// Velocity of the centre; zero if the file has no section `Velocities`.
    pub velocity: [f64; 3],
    /// Angular velocity in radians per unit of time; zero if the file has no section `Velocities`.
    pub angular_velocity: [f64; 3],
}

impl Atom {
    /// Returns the mass of a sphere, (π/6) d³ ρ.
    ///
    /// LAMMPS reads the density in a data file as that of a sphere, even in two-dimensional simulations with discs.
    /// There, `fix nve/sphere disc` changes only the moment of inertia.
    ///
    /// LIGGGHTS with `dimension 2` uses the mass (π/4) d² ρ instead, so this function does not apply.
    #[must_use]
    pub fn mass(&self) -> f64 {
        std::f64::consts::PI / 6.0 * self.diameter.powi(3) * self.density
    }

    /// Returns the radius, half the diameter.
    #[must_use]
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }
}

/// Reads the data file at `path`, plain or compressed by gzip or zstd.
///
/// # Errors
/// If the file cannot be read or is not a data file. See [`parse_data`].
pub fn read_data_file(path: &Path) -> Result<DataFile, ReadError> {
    parse_data(opened(path)?, &path.to_string_lossy())
}

/// Reads a data file from `reader`, plain or compressed by gzip or zstd. `name` is the name of the file in error
/// messages.
///
/// The header contains the number of atoms, the number of atom types and the three bounds of the box, in any order.
/// `Atoms` has lines `id type diameter density x y z`, optionally with three image counts at the end. `Velocities`
/// has lines `id vx vy vz wx wy wz`.
///
/// `Masses`, `Pair Coeffs` and `PairIJ Coeffs` are skipped. A position may be outside the box. Comments begin with `#`.
///
/// # Errors
/// If the input is truncated, is not text, or has content other than described above. Other content is never skipped,
/// because it could change the meaning of the file.
pub fn parse_data(reader: impl BufRead, name: &str) -> Result<DataFile, ReadError> {
    let mut lines = Lines::new(reader, name)?;
    let Some(title) = lines.next_text()?.map(|line| line.text.trim().to_owned()) else {
        return Err(lines.error("a data file that begins with a title", "an empty file"));
    };
    let mut parser = Parser::default();
    while let Some(line) = lines.next_text()? {
        parser.take(line)?;
    }
    parser.check_section().map_err(|(expected, found)| lines.error(expected, found))?;
    if !parser.atoms_seen {
        return Err(lines.error("a section `Atoms`", "the end of the file"));
    }
    let bounds = parser.header.bounds.map(Option::unwrap_or_default);
    Ok(DataFile { title, bounds: (bounds.map(|bound| bound.0), bounds.map(|bound| bound.1)), atoms: parser.atoms })
}

/// Expected and actual content, for an error.
type Mismatch = (String, String);

const BOUNDS: [[&str; 2]; 3] = [["xlo", "xhi"], ["ylo", "yhi"], ["zlo", "zhi"]];

/// Values of the header that have been read so far: numbers of atoms and atom types, and the box.
#[derive(Default)]
struct Header {
    atoms: Option<u64>,
    types: Option<u32>,
    bounds: [Option<(f64, f64)>; 3],
}

impl Header {
    /// Reads a line of the header. Returns false for a line that begins with a letter, such as the name of a section,
    /// and is no header line.
    fn take(&mut self, line: Line<'_>, content: &str) -> Result<bool, ReadError> {
        let words: Vec<&str> = content.split_whitespace().collect();
        let mut fields = Fields::new(line, content);
        match words[..] {
            [.., "xy", "xz", "yz"] => {
                return Err(line
                    .error("a box with right angles", "tilt factors `xy xz yz` (triclinic boxes are not supported)"));
            }
            [.., "atoms"] => {
                let count = fields.whole("a number of atoms, 1 or more, before `atoms`", 1..)?;
                expect_words(&words, 2, line, "`N atoms`")?;
                once(&mut self.atoms, count, line, "`N atoms`")?;
            }
            [.., "atom", "types"] => {
                let count = fields.whole("a number of types, 1 or more, before `atom types`", 1..)?;
                expect_words(&words, 3, line, "`N atom types`")?;
                once(&mut self.types, count, line, "`N atom types`")?;
            }
            [.., low, high] if BOUNDS.contains(&[low, high]) => {
                let label = format!("`LOW HIGH {low} {high}`");
                let bound =
                    (fields.finite(&format!("the number {low}"))?, fields.finite(&format!("the number {high}"))?);
                expect_words(&words, 4, line, &label)?;
                if bound.0 >= bound.1 {
                    let found = format!("{:?} and {:?}", bound.0, bound.1);
                    return Err(line.error(format!("{low} below {high}"), found));
                }
                let places = self.bounds.iter_mut().zip(BOUNDS);
                for (place, _) in places.filter(|(_, names)| *names == [low, high]) {
                    once(place, bound, line, &label)?;
                }
            }
            _ if begins_with_a_letter(content) => return Ok(false),
            _ => {
                let expected =
                    "a header line `N atoms`, `N atom types`, `… xlo xhi`, `… ylo yhi` or `… zlo zhi`, or a section";
                return Err(line.error(expected, quoted(content.trim())));
            }
        }
        Ok(true)
    }

    /// Checks that the header is complete.
    fn check(&self) -> Result<(), Mismatch> {
        let bounds = self.bounds.iter().zip(BOUNDS);
        let bounds = bounds.map(|(bound, [low, high])| (bound.is_some(), format!("LOW HIGH {low} {high}")));
        let counts = [(self.atoms.is_some(), "N atoms".to_owned()), (self.types.is_some(), "N atom types".to_owned())];
        match counts.into_iter().chain(bounds).find(|(is_there, _)| !is_there) {
            Some((_, what)) => Err((format!("a header line `{what}` before the sections"), "none".to_owned())),
            None => Ok(()),
        }
    }
}

/// Returns true for the keyword of a section. Header lines and entries of sections begin with a number.
fn begins_with_a_letter(content: &str) -> bool {
    content.trim_start().starts_with(char::is_alphabetic)
}

/// Returns an error unless a header line has `count` words. `form` is the expected form of the line.
fn expect_words(words: &[&str], count: usize, line: Line<'_>, form: &str) -> Result<(), ReadError> {
    if words.len() == count { Ok(()) } else { Err(line.error(form, quoted(&words.join(" ")))) }
}

/// Stores a value, or returns an error if it is already stored.
fn once<T>(place: &mut Option<T>, value: T, line: Line<'_>, form: &str) -> Result<(), ReadError> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(line.error(format!("one header line {form}"), "a second line of this form")),
    }
}

/// Section of a data file after the header.
#[derive(Clone, Copy)]
enum Section {
    Atoms,
    Velocities,
    /// Section without data of grains, which is skipped.
    PassedOver,
}

/// Parser of the lines of a data file after its title.
#[derive(Default)]
struct Parser {
    header: Header,
    /// Section of the next line; `None` in the header.
    section: Option<Section>,
    /// True for the line below the keyword of a section. The programs skip this line, so it must be blank.
    is_below_keyword: bool,
    /// Grains that have been read. No memory is reserved for the declared number of atoms, which may be wrong.
    atoms: Vec<Atom>,
    /// Index of each grain in `atoms` by its id, and true if its velocity has been read.
    known: HashMap<u32, (usize, bool)>,
    atoms_seen: bool,
    velocities_seen: bool,
}

impl Parser {
    /// Reads the next line.
    fn take(&mut self, line: Line<'_>) -> Result<(), ReadError> {
        let (content, comment) = line.text.split_once('#').unwrap_or((line.text, ""));
        let is_blank = content.trim().is_empty();
        if mem::take(&mut self.is_below_keyword) && !is_blank {
            return Err(line.error("a blank line below the keyword of the section", quoted(content.trim())));
        }
        if is_blank {
            return Ok(());
        }
        match self.section {
            None if self.header.take(line, content)? => return Ok(()),
            None => {}
            Some(_) if begins_with_a_letter(content) => {
                self.check_section().map_err(|(expected, found)| line.error(expected, found))?;
            }
            Some(Section::Atoms) => return self.take_atom(line, content),
            Some(Section::Velocities) => return self.take_velocity(line, content),
            Some(Section::PassedOver) => return Ok(()),
        }
        self.open(line, content, comment.trim())
    }

    /// Starts the section that `content` names.
    fn open(&mut self, line: Line<'_>, content: &str, comment: &str) -> Result<(), ReadError> {
        let section = match content.split_whitespace().collect::<Vec<_>>()[..] {
            ["Atoms"] => Section::Atoms,
            ["Velocities"] => Section::Velocities,
            ["Masses"] | ["Pair", "Coeffs"] | ["PairIJ", "Coeffs"] => Section::PassedOver,
            _ => {
                let expected = "a section `Atoms`, `Velocities`, `Masses`, `Pair Coeffs` or `PairIJ Coeffs`";
                return Err(line.error(expected, quoted(content.trim())));
            }
        };
        // In a section, the header has been checked already.
        self.header.check().map_err(|(expected, found)| line.error(expected, found))?;
        match section {
            Section::Atoms => {
                if mem::replace(&mut self.atoms_seen, true) {
                    return Err(line.error("one section `Atoms`", "a second section"));
                }
                if !matches!(comment, "" | "sphere" | "granular") {
                    return Err(line.error("grains, `Atoms # sphere`", quoted(&format!("Atoms # {comment}"))));
                }
            }
            Section::Velocities => {
                if mem::replace(&mut self.velocities_seen, true) {
                    return Err(line.error("one section `Velocities`", "a second section"));
                }
                if !self.atoms_seen {
                    return Err(line.error("the section `Atoms` before `Velocities`", "`Velocities`"));
                }
            }
            Section::PassedOver => {}
        }
        (self.section, self.is_below_keyword) = (Some(section), true);
        Ok(())
    }

    /// Checks that the current section, or the header, is complete.
    fn check_section(&self) -> Result<(), Mismatch> {
        let (name, count) = match self.section {
            None => return self.header.check(),
            Some(Section::Atoms) => ("Atoms", self.atoms.len()),
            Some(Section::Velocities) => ("Velocities", self.known.values().filter(|(_, moving)| *moving).count()),
            Some(Section::PassedOver) => return Ok(()),
        };
        let declared = self.header.atoms.unwrap_or_default();
        if count as u64 == declared {
            return Ok(());
        }
        let expected = format!("{declared} lines in the section `{name}`, one for each atom of the header");
        Err((expected, format!("only {count}")))
    }

    fn take_atom(&mut self, line: Line<'_>, content: &str) -> Result<(), ReadError> {
        let declared = self.header.atoms.unwrap_or_default();
        if self.atoms.len() as u64 >= declared {
            let expected = format!("{declared} atoms, as the header states");
            return Err(line.error(expected, format!("a further atom, {}", quoted(content.trim()))));
        }
        let mut fields = Fields::new(line, content);
        let id = fields.whole("the id of an atom, a whole number of 1 or more", 1_u32..)?;
        let types = self.header.types.unwrap_or_default();
        let type_range = format!("the type of an atom, a whole number from 1 to {types}");
        let type_ = fields.whole(&type_range, 1..=types)?;
        let atom = Atom {
            id,
            type_,
            diameter: fields.positive("a diameter, a finite number above 0")?,
            density: fields.positive("a density, a finite number above 0")?,
            position: fields.vector(["x, a finite number", "y, a finite number", "z, a finite number"])?,
            image: if fields.at_end() {
                [0; 3]
            } else {
                let mut image = || fields.whole("an image count, a whole number", ..);
                [image()?, image()?, image()?]
            },
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
        };
        fields.end("id, type, diameter, density, x, y, z and at most three image counts")?;
        let mass = atom.mass();
        if !mass.is_normal() {
            let found = format!("diameter {:e} and density {:e}", atom.diameter, atom.density);
            return Err(line.error("a finite mass of the grain", found));
        }
        if self.known.insert(id, (self.atoms.len(), false)).is_some() {
            return Err(line.error("an id that no other atom has", format!("{id} again")));
        }
        self.atoms.push(atom);
        Ok(())
    }

    fn take_velocity(&mut self, line: Line<'_>, content: &str) -> Result<(), ReadError> {
        let mut fields = Fields::new(line, content);
        let id = fields.whole("the id of an atom, a whole number of 1 or more", 1_u32..)?;
        let velocity = fields.vector(["vx, a finite number", "vy, a finite number", "vz, a finite number"])?;
        let spin = fields.vector(["wx, a finite number", "wy, a finite number", "wz, a finite number"])?;
        fields.end("id, vx, vy, vz, wx, wy, wz")?;
        let Some((index, moving)) = self.known.get_mut(&id) else {
            return Err(line.error("the id of an atom of the section `Atoms`", format!("{id}")));
        };
        if mem::replace(moving, true) {
            return Err(line.error("one velocity for an atom", format!("a second velocity for id {id}")));
        }
        if let Some(atom) = self.atoms.get_mut(*index) {
            atom.velocity = velocity;
            atom.angular_velocity = spin;
        }
        Ok(())
    }
}
