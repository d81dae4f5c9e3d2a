//! The keys of a problem file that each command reads: a key without effect is refused by name.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error as _, Visitor};

use super::document::{
    BarrierSection, Contact, Damping, DesignSection, Excitation, GeneticSection, LagrangianSection,
    LimitsSection, Pendulum, PrimarySection, Run, SphereSection,
};
use super::{Problem, ProblemError, refused};

/// The commands that read problem files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadingCommand {
    /// `lindstedt derive`
    Derive,
    /// `lindstedt compare`
    Compare,
    /// `lindstedt impact`
    Impact,
    /// `lindstedt simulate`
    Simulate,
    /// `lindstedt materials`
    Materials,
    /// `lindstedt lagrange`
    Lagrange,
    /// `lindstedt simulate` of an equation or a mechanism
    Trajectory,
    /// `lindstedt optimize`
    Optimize,
    /// `lindstedt stability`
    Stability,
    /// `lindstedt response`
    Response,
    /// `lindstedt orbits`
    Orbits,
    /// `lindstedt shortest`
    Shortest,
}

use ReadingCommand::{
    Compare, Derive, Impact, Lagrange, Materials, Optimize, Orbits, Response, Shortest, Simulate,
    Stability, Trajectory,
};

impl fmt::Display for ReadingCommand {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Derive => "lindstedt derive",
            Compare => "lindstedt compare",
            Impact => "lindstedt impact",
            Simulate | Trajectory => "lindstedt simulate",
            Materials => "lindstedt materials",
            Lagrange => "lindstedt lagrange",
            Optimize => "lindstedt optimize",
            Stability => "lindstedt stability",
            Response => "lindstedt response",
            Orbits => "lindstedt orbits",
            Shortest => "lindstedt shortest",
        })
    }
}

/// The commands that read a key, or refuse it with a specific message.
fn readers(section: &str, key: &str) -> &'static [ReadingCommand] {
    match (section, key) {
        ("", "equation") => {
            &[Derive, Compare, Impact, Simulate, Trajectory, Stability, Response, Orbits, Shortest]
        }
        ("", "method") => &[Derive, Impact, Response],
        ("", "order") => &[Derive, Impact, Stability, Response],
        ("", "of") => &[Response],
        ("", "vary" | "periods" | "along") => &[Response, Orbits],
        ("", "small") => &[Derive, Compare, Stability],
        ("", "resonance") => &[Derive, Response],
        ("", "amplitude") => &[Derive, Impact],
        ("", "about") => &[Derive, Compare, Impact],
        ("", "[values]") => {
            &[Derive, Compare, Impact, Lagrange, Trajectory, Stability, Response, Orbits, Shortest]
        }
        // A command that reads an equation of motion reads a mechanism as well.
        ("lagrangian", _) | ("", "[units]") => {
            &[Derive, Compare, Impact, Trajectory, Lagrange, Response]
        }
        ("primary", "force" | "frequency") | ("excitation", "frequency_ratio") => &[Simulate],
        ("primary", _) => &[Simulate, Materials, Optimize],
        ("contact", "force" | "law" | "linearisation") => &[Impact],
        ("pendulum", "side")
        | ("contact", "gamma")
        | ("excitation", _)
        | ("barrier", "poisson") => &[Impact, Simulate],
        ("damping", "friction") => &[Simulate, Materials, Optimize],
        ("sphere", "yield") => &[Impact, Materials, Optimize],
        ("barrier", "yield") => &[Impact, Optimize],
        ("run", "duration") => &[Simulate, Materials, Trajectory, Optimize],
        ("run", "step_limit") => &[Impact, Simulate, Materials, Trajectory, Optimize],
        ("", "[[material]]") => &[Materials, Optimize],
        ("", "[[wall]]") => &[Trajectory, Response, Orbits],
        ("", "[[event]]") => &[Trajectory, Response],
        ("", "static_friction") => &[Trajectory],
        ("", "[[wall]] contact") => &[Derive, Compare, Lagrange, Trajectory, Response, Shortest],
        ("limits" | "genetic", _) => &[Optimize],
        _ => &[Impact, Simulate, Materials, Optimize],
    }
}

type Keys = &'static [&'static str];
type KeySection = (&'static str, fn() -> Keys);

/// The sections, each with its keys, in the order in which unread ones are named.
const SECTIONS: [KeySection; 15] = [
    ("", || {
        &[
            "equation",
            "method",
            "order",
            "vary",
            "periods",
            "of",
            "along",
            "small",
            "resonance",
            "amplitude",
            "about",
            "static_friction",
            "[values]",
        ]
    }),
    ("lagrangian", keys_of::<LagrangianSection>),
    ("", || &["[units]"]),
    ("primary", keys_of::<PrimarySection>),
    ("pendulum", keys_of::<Pendulum>),
    ("contact", keys_of::<Contact>),
    ("damping", keys_of::<Damping>),
    ("excitation", keys_of::<Excitation>),
    ("design", keys_of::<DesignSection>),
    ("sphere", keys_of::<SphereSection>),
    ("barrier", keys_of::<BarrierSection>),
    ("run", keys_of::<Run>),
    ("", || &["[[material]]", "[[wall]]", "[[wall]] contact", "[[event]]"]),
    ("limits", keys_of::<LimitsSection>),
    ("genetic", keys_of::<GeneticSection>),
];

/// Every key of a problem file, as messages name it, and the commands that read it, or refuse it
/// with a specific message.
pub fn keys() -> impl Iterator<Item = (String, &'static [ReadingCommand])> {
    SECTIONS.into_iter().flat_map(|(section, keys)| {
        keys().iter().map(move |key| {
            let name = match section {
                "" => (*key).to_owned(),
                _ => format!("[{section}] {key}"),
            };
            (name, readers(section, key))
        })
    })
}

/// The keys that a section reads.
fn keys_of<'de, T: Deserialize<'de>>() -> Keys {
    let mut keys: Keys = &[];
    // The type requests its keys by name; the deserialiser records them and returns an error.
    let _ = T::deserialize(CollectNames(&mut keys));
    keys
}

struct CollectNames<'a>(&'a mut Keys);

impl<'de> Deserializer<'de> for CollectNames<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
        Err(Self::Error::custom("no value"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: Keys,
        visitor: V,
    ) -> Result<V::Value, Self::Error> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

/// The keys that a file gives.
pub(super) fn given(file: &toml::Table) -> Vec<String> {
    let mut keys = Vec::new();
    for (name, value) in file {
        match value {
            toml::Value::Table(_) if name == "values" || name == "units" => {
                keys.push(format!("[{name}]"))
            }
            toml::Value::Array(walls) if name == "wall" => {
                let is_compliant = |wall: &&toml::Value| wall.get("contact").is_some();
                let compliant = walls.iter().filter(is_compliant).count();
                // Walls that give way are terms of the equations.
                if compliant > 0 {
                    keys.push("[[wall]] contact".to_owned());
                }
                if compliant < walls.len() {
                    keys.push("[[wall]]".to_owned());
                }
            }
            toml::Value::Array(_) if ["material", "event"].contains(&name.as_str()) => {
                keys.push(format!("[[{name}]]"))
            }
            toml::Value::Table(section) => {
                keys.extend(section.keys().map(|key| format!("[{name}] {key}")))
            }
            _ => keys.push(name.clone()),
        }
    }
    keys
}

impl Problem {
    /// Whether the file gives this key: `order`, `[run] duration`.
    pub(super) fn has_key(&self, key: &str) -> bool {
        self.given.iter().any(|given| given == key)
    }

    /// Refuses keys that this command would ignore.
    ///
    /// # Errors
    /// [`ProblemError`] names the first, and the commands that read it.
    pub fn check_keys(&self, reader: ReadingCommand) -> Result<(), ProblemError> {
        let described = self.given.iter().any(|key| key.starts_with('[') && key != "[values]");
        if matches!(reader, Derive | Compare | Stability | Response | Orbits | Shortest)
            && self.equation.is_none()
            && self.lagrangian.is_none()
            && described
        {
            return refused(format!(
                "the file describes a pendulum and a barrier and has no `equation` for `{reader}`: use `lindstedt impact` or \
                 `lindstedt simulate`"
            ));
        }
        for (key, readers) in keys() {
            if self.has_key(&key) && !readers.contains(&reader) {
                // Two readers may belong to the same command.
                let own = format!("`{reader}`");
                let mut names: Vec<String> = Vec::new();
                for name in readers.iter().map(|reader| format!("`{reader}`")) {
                    if name != own && !names.contains(&name) {
                        names.push(name);
                    }
                }
                return refused(match names.is_empty() {
                    true => format!(
                        "`{key}` says nothing beside the equation, the mechanism or the main mass of the file: leave it out"
                    ),
                    false => format!(
                        "`{key}` says nothing to {own}: leave it out, or use {}",
                        names.join(" or ")
                    ),
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_of_a_study_has_its_key() {
        for parameter in crate::impact::Parameter::ALL {
            assert!(keys().any(|(key, _)| key == parameter.to_string()), "{parameter}");
        }
    }

    #[test]
    fn every_section_and_every_key_beside_them_is_listed() {
        let known: Vec<String> = keys().map(|(key, _)| key).collect();
        for name in keys_of::<Problem>() {
            let section = format!("[{name}]");
            assert!(known.iter().any(|key| key == name || key.contains(&section)), "{name}");
        }
        assert_eq!(known.len(), 102);
    }
}
