//! The pendulum and its bodies in SI units: `[design]`, or by their own names `[pendulum]`,
//! `[sphere]` and `[barrier]`.
//!
//! In: a [`Problem`]. Out: its [`StiffnessDesign`], from which gamma follows by equation (8), and
//! its [`Units`]. A quantity has two keys, one of which may be given. The modulus is that of the
//! barrier alone, as in the paper, unless `[barrier] poisson` is given: then that of a rigid sphere
//! on it, or with `[sphere] modulus` and `[sphere] poisson` that of both bodies.
//!
//! A given gamma takes precedence: the moduli are then not used, and there are units if mass,
//! length and gravity are all given.

use super::{Problem, ProblemError, refused};
use crate::impact::hertz::StiffnessDesign;
use crate::impact::{Elastic, Modulus, Units};

/// The keys of units, by their own names: those of the pendulum, the radius, those of the moduli,
/// those of yield limits.
const PENDULUM: [&str; 3] = ["[pendulum] mass", "[pendulum] length", "[pendulum] gravity"];
const RADIUS: [&str; 1] = ["[sphere] radius"];
const MODULI: [&str; 4] =
    ["[sphere] modulus", "[sphere] poisson", "[barrier] modulus", "[barrier] poisson"];
const YIELD: [&str; 2] = ["[sphere] yield", "[barrier] yield"];

impl Problem {
    /// The quantities from which gamma follows.
    ///
    /// # Errors
    /// A quantity given twice, or one by its own name that is not positive; half an equivalent
    /// modulus.
    pub(super) fn design(&self) -> Result<StiffnessDesign, ProblemError> {
        let usual = StiffnessDesign::from(self.design);
        let (pendulum, sphere) = (&self.pendulum, &self.sphere);
        Ok(StiffnessDesign {
            mass: self.one_of(["[pendulum] mass", "[design] mass"], pendulum.mass, usual.mass)?,
            radius: self.one_of(
                ["[sphere] radius", "[design] radius"],
                sphere.radius,
                usual.radius,
            )?,
            length: self.one_of(
                ["[pendulum] length", "[design] length"],
                pendulum.length,
                usual.length,
            )?,
            modulus: self.modulus()?.value(),
            gravity: self.one_of(
                ["[pendulum] gravity", "[design] gravity"],
                pendulum.gravity,
                usual.gravity,
            )?,
        })
    }

    /// A quantity by its own key, or by that of `[design]`.
    fn one_of(
        &self,
        keys: [&'static str; 2],
        own: Option<f64>,
        usual: f64,
    ) -> Result<f64, ProblemError> {
        let [key, other] = keys;
        match own {
            Some(_) if self.has_key(other) => {
                refused(format!("`{key}` and `{other}` say the same: give one of them"))
            }
            Some(value) => positive(key, value),
            None => Ok(usual),
        }
    }

    /// The modulus of the contact.
    fn modulus(&self) -> Result<Modulus, ProblemError> {
        let keys = ["[barrier] modulus", "[design] modulus"];
        let alone = self.one_of(keys, self.barrier.modulus, self.design.modulus)?;
        let key = keys[usize::from(self.barrier.modulus.is_none())];
        self.modulus_of([key, "[barrier] poisson"], alone, self.barrier.poisson)
    }

    /// The modulus of the contact of the sphere with a barrier, whose modulus and Poisson's ratio
    /// have these keys.
    pub(super) fn modulus_of(
        &self,
        [modulus_key, poisson_key]: [&'static str; 2],
        alone: f64,
        poisson_of_barrier: Option<f64>,
    ) -> Result<Modulus, ProblemError> {
        let poisson = |key: &str, value: Option<f64>| match value {
            Some(value) if !(value > -1.0 && value <= 0.5) => refused(format!(
                "`{key}` must lie above -1 and be at most 1/2, not {value}: it is 0.3 for steel"
            )),
            other => Ok(other),
        };
        let of_barrier = poisson(poisson_key, poisson_of_barrier)?;
        let of_sphere = poisson("[sphere] poisson", self.sphere.poisson)?;
        let barrier = |poisson| {
            let modulus = positive(modulus_key, alone)?;
            Ok::<_, ProblemError>(Elastic { modulus, poisson })
        };
        match (of_barrier, self.sphere.modulus, of_sphere) {
            (None, None, None) => Ok(Modulus::BarrierAlone(alone)),
            (Some(poisson), None, None) => Ok(Modulus::RigidSphere(barrier(poisson)?)),
            (Some(poisson), Some(modulus), Some(of_sphere)) => Ok(Modulus::Both {
                barrier: barrier(poisson)?,
                sphere: Elastic {
                    modulus: positive("[sphere] modulus", modulus)?,
                    poisson: of_sphere,
                },
            }),
            (_, Some(_), None) => needs("[sphere] modulus", "[sphere] poisson"),
            (_, None, Some(_)) => needs("[sphere] poisson", "[sphere] modulus"),
            (None, Some(_), Some(_)) => needs("[sphere] modulus", poisson_key),
        }
    }

    /// The units of an impact; `None` if they are not known: those of the pendulum with the contact
    /// of Hertz, or of the design if gamma follows from it.
    ///
    /// # Errors
    /// A key by its own name without effect.
    pub(super) fn units(
        &self,
        is_hertz: bool,
        gamma_follows: bool,
    ) -> Result<Option<Units>, ProblemError> {
        let design = self.design()?;
        let first = |keys: &[&'static str]| keys.iter().copied().find(|key| self.has_key(key));
        let silent = |groups: &[&[&'static str]]| first(&groups.concat());
        let [sphere_yield, barrier_yield] =
            [(YIELD[0], self.sphere.yield_limit), (YIELD[1], self.barrier.yield_limit)]
                .map(|(key, limit)| limit.map(|limit| positive(key, limit)).transpose());
        let units = Units {
            mass: design.mass,
            length: design.length,
            gravity: design.gravity,
            radius: Some(design.radius),
            modulus: Some(self.modulus()?),
            sphere_yield: sphere_yield?,
            barrier_yield: barrier_yield?,
        };
        if !is_hertz {
            let unused = match gamma_follows {
                true => silent(&[&YIELD]),
                false => silent(&[&PENDULUM, &RADIUS, &MODULI, &YIELD]),
            };
            return match unused {
                Some(key) => refused(format!(
                    "`{key}` says nothing here: SI units are those of the pendulum with the contact of Hertz, leave it out or leave \
                     out `equation` and `force`"
                )),
                None => Ok(None),
            };
        }
        if gamma_follows {
            return Ok(Some(units));
        }
        if let Some(key) = first(&MODULI) {
            return refused(format!(
                "`{key}` changes nothing where gamma is given: leave one of them out"
            ));
        }
        let given =
            |name: &str, own: &str| self.has_key(own) || self.has_key(&format!("[design] {name}"));
        let needed = ["mass", "length", "gravity"].into_iter().zip(PENDULUM);
        let missing: Vec<&str> =
            needed.filter(|(name, own)| !given(name, own)).map(|(name, _)| name).collect();
        if !missing.is_empty() {
            return match silent(&[&PENDULUM, &RADIUS, &YIELD]) {
                Some(key) => refused(format!(
                    "`{key}` says nothing beside a gamma that is given: SI units need mass, length and gravity as well, give {}, or \
                     leave it out",
                    missing.join(" and ")
                )),
                None => Ok(None),
            };
        }
        let radius = given("radius", RADIUS[0]).then_some(design.radius);
        if let (None, Some(key)) = (radius, first(&YIELD)) {
            return refused(format!(
                "`{key}` is held against the peak pressure, which beside a gamma that is given needs the radius: give [sphere] radius"
            ));
        }
        positive("[design] mass", design.mass)?;
        positive("[design] length", design.length)?;
        positive("[design] gravity", design.gravity)?;
        if let Some(radius) = radius {
            positive("[design] radius", radius)?;
        }
        Ok(Some(Units { radius, modulus: None, ..units }))
    }
}

impl Problem {
    /// The units of a motion, by the rule of [`Problem::units`]: by the design if gamma follows
    /// from it or a damping is given in SI units; otherwise if mass, length and gravity are given.
    /// Keys without effect are not an error here.
    pub(super) fn simulation_units(&self, design: &StiffnessDesign) -> Option<Units> {
        let given = |name: &str| {
            let keys = [format!("[pendulum] {name}"), format!("[design] {name}")];
            keys.iter().any(|key| self.has_key(key))
        };
        let follows = self.contact.gamma.is_none() || self.damps_in_si_units();
        let known = follows || ["mass", "length", "gravity"].into_iter().all(given);
        let sizes = [design.mass, design.length, design.gravity];
        let sound = sizes.iter().all(|size| size.is_finite() && *size > 0.0);
        (known && sound).then_some(Units {
            mass: design.mass,
            length: design.length,
            gravity: design.gravity,
            radius: Some(design.radius),
            modulus: None,
            sphere_yield: None,
            barrier_yield: None,
        })
    }
}

/// Checks that the number of a key is positive.
///
/// # Errors
/// A number that is not positive.
pub(super) fn positive(key: &str, value: f64) -> Result<f64, ProblemError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => refused(format!("`{key}` must be a positive number, not {value}")),
    }
}

/// The error of an incomplete equivalent modulus.
pub(super) fn needs<T>(key: &str, missing: &str) -> Result<T, ProblemError> {
    refused(format!(
        "`{key}` needs `{missing}` beside it: the modulus of both bodies is 1/E = (1 - nu1^2)/E1 + (1 - nu2^2)/E2; without any of \
         them it is that of the barrier alone"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(text: &str) -> Result<StiffnessDesign, ProblemError> {
        text.parse::<Problem>().unwrap().design()
    }

    #[test]
    fn either_name_says_the_same() {
        let old =
            "[design]\nmass = 0.02\nradius = 0.01\nlength = 0.25\nmodulus = 2e9\ngravity = 1.6";
        let new = "[pendulum]\nmass = 0.02\nlength = 0.25\ngravity = 1.6\n[sphere]\nradius = 0.01\n[barrier]\nmodulus = 2e9";
        assert_eq!(design(old), design(new));
        assert_eq!(design(""), Ok(StiffnessDesign::default()));
    }

    #[test]
    fn moduli_that_are_half_given_name_what_is_missing() {
        let rigid = design("[barrier]\nmodulus = 2e9\npoisson = 0.5").unwrap();
        assert!((rigid.modulus / (2e9 / 0.75) - 1.0).abs() < 1e-15);
        for (text, words) in [
            ("[sphere]\nmodulus = 2e11", ["[sphere] modulus", "[sphere] poisson"]),
            ("[sphere]\npoisson = 0.3", ["[sphere] poisson", "[sphere] modulus"]),
            ("[sphere]\nmodulus = 2e11\npoisson = 0.3", ["[sphere] modulus", "[barrier] poisson"]),
            ("[barrier]\npoisson = -1", ["[barrier] poisson", "-1"]),
            ("[design]\nmodulus = -2\n[barrier]\npoisson = 0.3", ["[design] modulus", "-2"]),
        ] {
            let error = design(text).unwrap_err().to_string();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        }
    }

    #[test]
    fn a_gamma_that_is_given_leaves_units_to_what_is_given_beside_it() {
        let units = |text: &str| text.parse::<Problem>().unwrap().units(true, false);
        assert_eq!(units(""), Ok(None));
        assert_eq!(units("[design]\nmass = 0.02"), Ok(None));
        let all = "[design]\nmass = 0.02\n[pendulum]\nlength = 0.25\ngravity = 1.6\n";
        let found = units(all).unwrap().unwrap();
        assert_eq!((found.radius, found.modulus, found.length), (None, None, 0.25));
        let found = units(&format!("{all}[sphere]\nradius = 0.01\nyield = 1e9")).unwrap().unwrap();
        assert_eq!((found.radius, found.sphere_yield), (Some(0.01), Some(1e9)));
        for (text, words) in [
            ("[pendulum]\nmass = 1", "give length and gravity"),
            (&format!("{all}[barrier]\nyield = 1e9"), "needs the radius"),
            (&format!("{all}[barrier]\nmodulus = 1e9"), "changes nothing where gamma is given"),
        ] {
            let error = units(text).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
