//! Which command reads which key of a problem file: a key that would change nothing is refused by
//! name.

use std::fmt;

use super::{Problem, ProblemError, refused};

/// The commands that read problem files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reader {
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
}

use Reader::{
    Compare, Derive, Impact, Lagrange, Materials, Optimize, Response, Simulate, Stability,
    Trajectory,
};

impl fmt::Display for Reader {
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
        })
    }
}

/// Those that read an equation of motion, and with it a mechanism.
const MECHANISM: [Reader; 6] = [Derive, Compare, Impact, Trajectory, Lagrange, Response];

/// Every key, as messages name it, and the commands that read it, or refuse it with a reason of
/// their own.
pub const KEYS: [(&str, &[Reader]); 95] = [
    ("equation", &[Derive, Compare, Impact, Simulate, Trajectory, Stability, Response]),
    ("method", &[Derive, Impact, Response]),
    ("order", &[Derive, Impact, Stability, Response]),
    ("vary", &[Response]),
    ("periods", &[Response]),
    ("small", &[Derive, Compare, Stability]),
    ("amplitude", &[Derive, Impact]),
    ("about", &[Derive, Compare, Impact]),
    ("[values]", &[Derive, Compare, Impact, Lagrange, Trajectory, Stability, Response]),
    ("[lagrangian] coordinates", &MECHANISM),
    ("[lagrangian] kinetic", &MECHANISM),
    ("[lagrangian] potential", &MECHANISM),
    ("[lagrangian] dissipation", &MECHANISM),
    ("[lagrangian] forces", &MECHANISM),
    ("[units]", &MECHANISM),
    ("[primary] mass", &[Simulate, Optimize]),
    ("[primary] stiffness", &[Simulate, Optimize]),
    ("[primary] damping", &[Simulate, Optimize]),
    ("[primary] displacement", &[Simulate, Optimize]),
    ("[primary] speed", &[Simulate, Optimize]),
    ("[primary] force", &[Simulate]),
    ("[primary] frequency", &[Simulate]),
    ("[pendulum] amplitude", &[Impact, Simulate, Materials, Optimize]),
    ("[pendulum] barrier", &[Impact, Simulate, Materials, Optimize]),
    ("[pendulum] side", &[Impact, Simulate]),
    ("[pendulum] start", &[Impact, Simulate, Materials, Optimize]),
    ("[pendulum] speed", &[Impact, Simulate, Materials, Optimize]),
    ("[pendulum] mass", &[Impact, Simulate, Materials, Optimize]),
    ("[pendulum] length", &[Impact, Simulate, Materials, Optimize]),
    ("[pendulum] gravity", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] gamma", &[Impact, Simulate]),
    ("[contact] force", &[Impact]),
    ("[contact] mu", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] mu_over_gamma", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] lambda", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] restitution", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] at_speed", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] damping", &[Impact, Simulate, Materials, Optimize]),
    ("[contact] law", &[Impact]),
    ("[contact] linearisation", &[Impact]),
    ("[damping] zeta", &[Impact, Simulate, Materials, Optimize]),
    ("[damping] viscous", &[Impact, Simulate, Materials, Optimize]),
    ("[damping] alpha", &[Impact, Simulate, Materials, Optimize]),
    ("[damping] torque", &[Impact, Simulate, Materials, Optimize]),
    ("[damping] friction", &[Simulate, Materials, Optimize]),
    ("[excitation] beta", &[Impact, Simulate]),
    ("[excitation] frequency_ratio", &[Simulate]),
    ("[design] mass", &[Impact, Simulate, Materials, Optimize]),
    ("[design] radius", &[Impact, Simulate, Materials, Optimize]),
    ("[design] length", &[Impact, Simulate, Materials, Optimize]),
    ("[design] modulus", &[Impact, Simulate, Materials, Optimize]),
    ("[design] gravity", &[Impact, Simulate, Materials, Optimize]),
    ("[sphere] radius", &[Impact, Simulate, Materials, Optimize]),
    ("[sphere] modulus", &[Impact, Simulate, Materials, Optimize]),
    ("[sphere] poisson", &[Impact, Simulate, Materials, Optimize]),
    ("[sphere] yield", &[Impact, Materials, Optimize]),
    ("[barrier] modulus", &[Impact, Simulate, Materials, Optimize]),
    ("[barrier] poisson", &[Impact, Simulate]),
    ("[barrier] yield", &[Impact, Optimize]),
    ("[run] duration", &[Simulate, Materials, Trajectory, Optimize]),
    ("[run] integrator_tolerance", &[Impact, Simulate, Materials, Optimize]),
    ("[run] step_limit", &[Impact, Simulate, Materials, Trajectory, Optimize]),
    ("[[material]]", &[Materials, Optimize]),
    ("[limits] mass", &[Optimize]),
    ("[limits] radius", &[Optimize]),
    ("[limits] length", &[Optimize]),
    ("[limits] modulus", &[Optimize]),
    ("[limits] density", &[Optimize]),
    ("[limits] elastic", &[Optimize]),
    ("[limits] max_rest_time", &[Optimize]),
    ("[limits] max_dimensionless_rest_time", &[Optimize]),
    ("[limits] max_peak_force", &[Optimize]),
    ("[limits] max_peak_pressure", &[Optimize]),
    ("[limits] max_impacts", &[Optimize]),
    ("[limits] max_primary_rest_time", &[Optimize]),
    ("[genetic] objective", &[Optimize]),
    ("[genetic] population", &[Optimize]),
    ("[genetic] generations", &[Optimize]),
    ("[genetic] elite", &[Optimize]),
    ("[genetic] crossover_fraction", &[Optimize]),
    ("[genetic] crossover", &[Optimize]),
    ("[genetic] crossover_ratio", &[Optimize]),
    ("[genetic] mutation", &[Optimize]),
    ("[genetic] mutation_rate", &[Optimize]),
    ("[genetic] coding", &[Optimize]),
    ("[genetic] bits", &[Optimize]),
    ("[genetic] penalty", &[Optimize]),
    ("[genetic] initial_penalty", &[Optimize]),
    ("[genetic] penalty_factor", &[Optimize]),
    ("[genetic] constraint_tolerance", &[Optimize]),
    ("[genetic] stall_generations", &[Optimize]),
    ("[genetic] function_tolerance", &[Optimize]),
    ("[genetic] stall_test", &[Optimize]),
    ("[genetic] runs", &[Optimize]),
    ("[genetic] seed", &[Optimize]),
];

/// The keys that a file gives.
pub(super) fn given(file: &toml::Table) -> Vec<String> {
    let mut keys = Vec::new();
    for (name, value) in file {
        match value {
            toml::Value::Table(_) if name == "values" || name == "units" => {
                keys.push(format!("[{name}]"))
            }
            toml::Value::Array(_) if name == "material" => keys.push("[[material]]".to_owned()),
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
    pub(super) fn gives(&self, key: &str) -> bool {
        self.given.iter().any(|given| given == key)
    }

    /// Refuses keys that this command would ignore.
    ///
    /// # Errors
    /// [`ProblemError`] names the first, and the commands that read it.
    pub fn check_keys(&self, reader: Reader) -> Result<(), ProblemError> {
        let described = self.given.iter().any(|key| key.starts_with('[') && key != "[values]");
        if matches!(reader, Derive | Compare | Stability | Response)
            && self.equation.is_none()
            && self.lagrangian.is_none()
            && described
        {
            return refused(format!(
                "the file describes a pendulum and a barrier and has no `equation` for `{reader}`: use `lindstedt impact` or \
                 `lindstedt simulate`"
            ));
        }
        for (key, readers) in KEYS {
            if self.gives(key) && !readers.contains(&reader) {
                // Two readers may be one command.
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
            assert!(KEYS.iter().any(|(key, _)| *key == parameter.to_string()), "{parameter}");
        }
    }

    #[test]
    fn every_key_that_a_file_may_have_is_listed() {
        // The parser lists what it expects where it meets something else.
        for (section, prefix) in [
            ("", ""),
            ("pendulum", "[pendulum] "),
            ("contact", "[contact] "),
            ("damping", "[damping] "),
            ("excitation", "[excitation] "),
            ("design", "[design] "),
            ("sphere", "[sphere] "),
            ("barrier", "[barrier] "),
            ("run", "[run] "),
            ("lagrangian", "[lagrangian] "),
            ("primary", "[primary] "),
            ("limits", "[limits] "),
            ("genetic", "[genetic] "),
        ] {
            let text = match section {
                "" => "nonsense = 1".to_owned(),
                section => format!("[{section}]\nnonsense = 1"),
            };
            let error = toml::from_str::<Problem>(&text).unwrap_err();
            let expected: Vec<&str> = error.message().split('`').skip(3).step_by(2).collect();
            assert!(expected.len() > 1, "{error}");
            for name in expected {
                let key = format!("{prefix}{name}");
                let is_section = KEYS.iter().any(|(known, _)| known.contains(&format!("[{name}]")));
                let known = KEYS.iter().any(|(known, _)| *known == key);
                assert!(known || prefix.is_empty() && is_section, "{key}");
            }
        }
    }
}
