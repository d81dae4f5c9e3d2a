//! The input of `materials` from a problem file: a design, its damping, and `[[material]]`, the
//! barriers that are tried.
//!
//! In: a [`Problem`], with `[primary]` that of a main mass which carries the pendulum. Out: a
//! [`MaterialQuestion`]. The modulus of the contact of a material follows
//! the rule of the other files: that of the material alone, as in the paper; or with its Poisson's
//! ratio that under a rigid sphere, or of both bodies if `[sphere]` has a modulus.

use super::design::{needs, positive};
use super::document::MaterialSection;
use super::primary::{in_si, long_enough};
use super::simulate::{message_of_missing_key, refuse_two_forms};
use super::{Problem, ProblemError, ReadingCommand, SphereSection, refused};
use crate::impact::{
    ContactDamping, DEFAULT_DURATION, DEFAULT_ZETA, Integrator, Material, MaterialQuestion,
    Modulus, Parameter, default_lambda,
};

impl Problem {
    /// The study of this file: of the materials of the paper's Table 2 and its own, or with
    /// `only_own` only of its own.
    ///
    /// # Errors
    /// [`ProblemError`] names the key, or the material.
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[[material]]\nname = \"Rubber\"\nmodulus = 1e7\nrestitution = 0.6".parse()?;
    /// assert_eq!(file.materials(false)?.materials.len(), 4);
    /// assert_eq!(file.materials(true)?.materials[0].name, "Rubber");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn materials(&self, only_own: bool) -> Result<MaterialQuestion, ProblemError> {
        self.check_keys(ReadingCommand::Materials)?;
        let gives = |parameter| self.gives_parameter(parameter);
        refuse_two_forms(gives)?;
        self.check_pairs(gives)?;
        let mut case = self.for_design().case()?;
        if case.left.is_none() && case.right.is_none() {
            return refused("a study of materials needs a barrier: leave out `barrier = false`");
        }
        self.check_materials()?;
        let mut settings = self.settings()?;
        let mut defaults = Vec::new();
        if !ContactDamping::FORMS.into_iter().any(gives) {
            case.contact_damping = ContactDamping::Lambda(default_lambda());
            defaults.push(Parameter::Lambda);
        }
        if !gives(Parameter::Zeta) && !gives(Parameter::Viscous) {
            case.zeta = DEFAULT_ZETA;
            defaults.push(Parameter::Zeta);
        }
        let main_mass = match &self.primary {
            None => None,
            Some(section) => Some(self.main_mass_carrying(section, &mut case)?),
        };
        if !self.has_key("[run] duration") {
            settings.duration = match main_mass {
                None => DEFAULT_DURATION,
                Some(main_mass) => long_enough(&main_mass.primary(&in_si(&case.design))),
            };
        }
        let mut materials = match only_own {
            true => vec![],
            false => Material::defaults(),
        };
        self.own_materials(&mut materials)?;
        Ok(MaterialQuestion {
            case,
            materials,
            sphere_yield: self.yield_limit("[sphere] yield", self.sphere.yield_limit)?,
            main_mass,
            settings,
            integrator: Integrator::Taylor,
            defaults,
        })
    }

    /// Returns the file as a description of the design alone, whose barrier has the modulus at
    /// which the damping is the given one.
    pub(super) fn for_design(&self) -> Self {
        Self {
            sphere: SphereSection { modulus: None, poisson: None, ..self.sphere },
            ..self.clone()
        }
    }

    /// Refuses an empty list.
    pub(super) fn check_materials(&self) -> Result<(), ProblemError> {
        match self.material.is_empty() && self.has_key("[[material]]") {
            true => refused(
                "`material = []` lists no material: give [[material]] with a name and a modulus, or leave it out",
            ),
            false => Ok(()),
        }
    }

    /// Appends the materials of the file to `materials`.
    pub(super) fn own_materials(&self, materials: &mut Vec<Material>) -> Result<(), ProblemError> {
        for section in &self.material {
            let material = self.a_material(section)?;
            if materials.iter().any(|known| known.name == material.name) {
                return refused(format!(
                    "two materials are called `{}`: give one of them another name",
                    material.name
                ));
            }
            materials.push(material);
        }
        let two_bodies = self.sphere.modulus.is_some() || self.sphere.poisson.is_some();
        if two_bodies && self.material.iter().all(|material| material.poisson.is_none()) {
            let key =
                if self.sphere.modulus.is_some() { "[sphere] modulus" } else { "[sphere] poisson" };
            return needs(key, "[[material]] poisson");
        }
        Ok(())
    }

    fn a_material(&self, section: &MaterialSection) -> Result<Material, ProblemError> {
        let name = section.name.trim().to_owned();
        if name.is_empty() {
            return refused(
                "a [[material]] has an empty name: give it one, for the tables go by it",
            );
        }
        let keys = ["[[material]] modulus", "[[material]] poisson"];
        let of_material = |error| ProblemError::new(format!("material `{name}`: {error}"));
        let modulus = match section.poisson {
            None => positive(keys[0], section.modulus).map(Modulus::BarrierAlone),
            Some(_) => self.modulus_of(keys, section.modulus, section.poisson),
        };
        let dampings = section.given_dampings();
        if let [one, other, ..] = dampings[..] {
            return refused(format!(
                "material `{name}`: `{}` and `{}` say the same: give one of them",
                one.form().name(),
                other.form().name()
            ));
        }
        if section.at_speed.is_some() && section.restitution.is_none() {
            return refused(format!(
                "material `{name}`: {}",
                message_of_missing_key("at_speed", &"restitution")
            ));
        }
        Ok(Material {
            modulus: modulus.map_err(of_material)?,
            yield_limit: self
                .yield_limit("[[material]] yield", section.yield_limit)
                .map_err(of_material)?,
            damping: dampings.first().copied(),
            at_speed: section.at_speed,
            name,
        })
    }

    pub(super) fn yield_limit(
        &self,
        key: &'static str,
        limit: Option<f64>,
    ) -> Result<Option<f64>, ProblemError> {
        limit.map(|limit| positive(key, limit)).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::hertz::StiffnessDesign;

    fn asked(text: &str) -> Result<MaterialQuestion, ProblemError> {
        text.parse::<Problem>().unwrap().materials(false)
    }

    #[test]
    fn an_empty_file_is_the_default_study() {
        let (of_file, of_library) = (asked("").unwrap(), MaterialQuestion::default());
        assert_eq!((&of_file.case, &of_file.materials), (&of_library.case, &of_library.materials));
        assert_eq!(of_file.defaults, of_library.defaults);
        assert_eq!(of_file.settings.duration, of_library.settings.duration);
        assert_eq!(asked("[damping]\nviscous = 0.1").unwrap().case.zeta, 0.0);
    }

    #[test]
    fn a_material_has_the_modulus_of_its_bodies() {
        let moduli = |text: &str| {
            let asked = asked(text).unwrap();
            assert_eq!(asked.case.design, StiffnessDesign::default());
            asked.materials[3..].iter().map(|material| material.modulus.value()).collect::<Vec<_>>()
        };
        let cork = "[[material]]\nname = \"cork\"\nmodulus = 2e7\n";
        assert_eq!(moduli(cork), [2e7]);
        assert_eq!(moduli(&format!("{cork}poisson = 0.5")), [2e7 / 0.75]);
        let both = moduli(&format!("{cork}poisson = 0.5\n[sphere]\nmodulus = 1e8\npoisson = 0"));
        assert!((both[0] * (0.75 / 2e7 + 1.0 / 1e8) - 1.0).abs() < 1e-15);
    }
}
