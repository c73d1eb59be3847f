//! Parser of a data file, line by line.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::read::atom::Atom;
use crate::read::data_header::DataHeader;
use crate::read::fields::Fields;
use crate::read::lines::Line;
use crate::read::read_error::{ReadError, quoted};

/// Section of a data file after the header.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Atoms,
    Velocities,
    /// Section without data of grains, which is skipped.
    PassedOver,
}

impl Section {
    /// Returns the section that a keyword line without comment names.
    fn named(keyword: &str) -> Option<Self> {
        match keyword.split_whitespace().collect::<Vec<_>>()[..] {
            ["Atoms"] => Some(Self::Atoms),
            ["Velocities"] => Some(Self::Velocities),
            ["Masses"] | ["Pair", "Coeffs"] | ["PairIJ", "Coeffs"] => Some(Self::PassedOver),
            _ => None,
        }
    }
}

/// Position of the next line in a data file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Header,
    /// Line below the keyword of a section. The programs skip this line, so it must be blank.
    BelowKeyword(Section),
    Within(Section),
}

/// Parser of the lines of a data file after its title.
pub(crate) struct DataParser {
    stage: Stage,
    header: DataHeader,
    atoms: Vec<Atom>,
    /// Index of each grain in `atoms` by its id, and true if its velocity has been read.
    known: HashMap<u32, (usize, bool)>,
    atoms_seen: bool,
    velocities_seen: bool,
    velocities: u64,
}

/// Lower and upper corner of the box.
type Bounds = ([f64; 3], [f64; 3]);

impl DataParser {
    pub(crate) fn new() -> Self {
        Self {
            stage: Stage::Header,
            header: DataHeader::default(),
            // No memory is reserved for the declared number of atoms, which may be wrong.
            atoms: Vec::new(),
            known: HashMap::new(),
            atoms_seen: false,
            velocities_seen: false,
            velocities: 0,
        }
    }

    /// Reads the next line.
    pub(crate) fn take(&mut self, line: Line<'_>) -> Result<(), ReadError> {
        let (content, comment) = match line.text.split_once('#') {
            Some((content, comment)) => (content, comment.trim()),
            None => (line.text, ""),
        };
        let is_blank = content.trim().is_empty();
        if let Stage::BelowKeyword(section) = self.stage {
            self.stage = Stage::Within(section);
            if !is_blank {
                let found = quoted(content.trim());
                return Err(line.error("a blank line below the keyword of the section", found));
            }
        }
        if is_blank {
            return Ok(());
        }
        match self.stage {
            Stage::Header => {
                if !self.header.take(line, content)? {
                    self.open(line, content, comment)?;
                }
                Ok(())
            }
            Stage::BelowKeyword(section) | Stage::Within(section) => {
                // Entries of sections begin with a number, and keywords with a letter.
                if content.trim_start().starts_with(char::is_alphabetic) {
                    self.close(section, |expected, found| line.error(expected, found))?;
                    return self.open(line, content, comment);
                }
                match section {
                    Section::Atoms => self.take_atom(line, content),
                    Section::Velocities => self.take_velocity(line, content),
                    Section::PassedOver => Ok(()),
                }
            }
        }
    }

    /// Returns the box and the grains after the last line. `missing` creates the error for missing content.
    pub(crate) fn finish(
        self,
        missing: impl Fn(String, String) -> ReadError,
    ) -> Result<(Bounds, Vec<Atom>), ReadError> {
        match self.stage {
            Stage::Header => self.header.complete(&missing)?,
            Stage::BelowKeyword(section) | Stage::Within(section) => {
                self.close(section, &missing)?;
            }
        }
        if !self.atoms_seen {
            return Err(missing("a section `Atoms`".to_owned(), "the end of the file".to_owned()));
        }
        Ok((self.header.bounds(), self.atoms))
    }

    /// Starts the section that `content` names.
    fn open(&mut self, line: Line<'_>, content: &str, comment: &str) -> Result<(), ReadError> {
        let Some(section) = Section::named(content) else {
            let expected = "a section `Atoms`, `Velocities`, `Masses`, `Pair Coeffs` or `PairIJ Coeffs`";
            return Err(line.error(expected, quoted(content.trim())));
        };
        if self.stage == Stage::Header {
            self.header.complete(|expected, found| line.error(expected, found))?;
        }
        match section {
            Section::Atoms => {
                if std::mem::replace(&mut self.atoms_seen, true) {
                    return Err(line.error("one section `Atoms`", "a second section"));
                }
                if !matches!(comment, "" | "sphere" | "granular") {
                    let found = quoted(&format!("Atoms # {comment}"));
                    return Err(line.error("grains, `Atoms # sphere`", found));
                }
            }
            Section::Velocities => {
                if std::mem::replace(&mut self.velocities_seen, true) {
                    return Err(line.error("one section `Velocities`", "a second section"));
                }
                if !self.atoms_seen {
                    let expected = "the section `Atoms` before `Velocities`";
                    return Err(line.error(expected, "`Velocities`"));
                }
            }
            Section::PassedOver => {}
        }
        self.stage = Stage::BelowKeyword(section);
        Ok(())
    }

    /// Checks that a section is complete at its end. `missing` creates the error.
    fn close(&self, section: Section, missing: impl Fn(String, String) -> ReadError) -> Result<(), ReadError> {
        let (name, count) = match section {
            Section::Atoms => ("Atoms", self.atoms.len() as u64),
            Section::Velocities => ("Velocities", self.velocities),
            Section::PassedOver => return Ok(()),
        };
        let declared = self.header.atom_count();
        if count == declared {
            return Ok(());
        }
        Err(missing(
            format!("{declared} lines in the section `{name}`, one for each atom of the header"),
            format!("only {count}"),
        ))
    }

    fn take_atom(&mut self, line: Line<'_>, content: &str) -> Result<(), ReadError> {
        let declared = self.header.atom_count();
        if self.atoms.len() as u64 >= declared {
            let expected = format!("{declared} atoms, as the header states");
            return Err(line.error(expected, format!("a further atom, {}", quoted(content.trim()))));
        }
        let mut fields = Fields::between_blanks(line, content);
        let id = fields.whole("the id of an atom, a whole number of 1 or more", 1_u32)?;
        let types = self.header.type_count();
        let type_range = format!("the type of an atom, a whole number from 1 to {types}");
        let type_ = fields.whole_up_to(&type_range, 1_u32, types)?;
        let atom = Atom {
            id,
            type_,
            diameter: fields.positive("a diameter, a finite number above 0")?,
            density: fields.positive("a density, a finite number above 0")?,
            position: fields.vector(["x, a finite number", "y, a finite number", "z, a finite number"])?,
            image: if fields.at_end() {
                [0; 3]
            } else {
                let mut image = || fields.whole("an image count, a whole number", i32::MIN);
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
        match self.known.entry(id) {
            Entry::Occupied(_) => Err(line.error("an id that no other atom has", format!("{id} again"))),
            Entry::Vacant(place) => {
                place.insert((self.atoms.len(), false));
                self.atoms.push(atom);
                Ok(())
            }
        }
    }

    fn take_velocity(&mut self, line: Line<'_>, content: &str) -> Result<(), ReadError> {
        let mut fields = Fields::between_blanks(line, content);
        let id = fields.whole("the id of an atom, a whole number of 1 or more", 1_u32)?;
        let velocity = fields.vector(["vx, a finite number", "vy, a finite number", "vz, a finite number"])?;
        let spin = fields.vector(["wx, a finite number", "wy, a finite number", "wz, a finite number"])?;
        fields.end("id, vx, vy, vz, wx, wy, wz")?;
        let Some((index, moving)) = self.known.get_mut(&id) else {
            return Err(line.error("the id of an atom of the section `Atoms`", format!("{id}")));
        };
        if std::mem::replace(moving, true) {
            return Err(line.error("one velocity for an atom", format!("a second velocity for id {id}")));
        }
        if let Some(atom) = self.atoms.get_mut(*index) {
            atom.velocity = velocity;
            atom.angular_velocity = spin;
        }
        self.velocities += 1;
        Ok(())
    }
}
