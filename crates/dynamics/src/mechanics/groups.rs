//! Dimensionless groups: the numbers on which a motion depends.
//!
//! ```text
//! n parameters of r independent dimensions leave n - r numbers       (Buckingham 1914)
//! Pi_p = p / (b_1^e_1 ... b_r^e_r)     b: as many parameters as give the units, first of inertia, then of stiffness
//! ```
//!
//! (E. Buckingham, *Phys. Rev.* 4 (1914) 345.) If no product of parameters has the unit of a
//! coordinate, as for a mass on a linear spring, the size of the motion is a unit: `x0` for the
//! coordinate `x`, which may be any length. In the units b the equations are those with every
//! b = 1. A product of powers that occurs only as a whole is then one group, so that an equation
//! often depends on fewer numbers than the theorem allows. A group is named after the factor that
//! it multiplies: `zeta` (times two) a velocity, `alpha` its sign, `beta` an excitation, `eta` the
//! time in an excitation, `gamma` and `mu` a contact and its damping; any other is `Pi1`, `Pi2`,
//! ...

use std::collections::{BTreeMap, BTreeSet};

use num_traits::{One, Signed, Zero};

use super::{Combination, Dimension, EquationsOfMotion, MechanicsError, Mechanism};
use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node, fresh};
use crate::symbol::Symbol;

/// The dimensionless form of equations of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Groups {
    /// The number of parameters of the equations.
    pub parameters: usize,
    /// The rank of the matrix of their dimensions.
    pub rank: usize,
    /// The parameters that serve as units, as many as the rank, and the sizes of the motion that
    /// serve as units.
    pub units: Vec<Symbol>,
    /// The coordinates whose unit is not a product of parameters, each with the name of the size
    /// that serves as its unit.
    pub sizes: Vec<(Symbol, Symbol)>,
    /// The sums of parameters that count as one, under the names that they have in the groups.
    pub combinations: Vec<Combination>,
    /// The unit of time, as a product of powers of the units.
    pub time: Expr,
    /// The unit of each coordinate, as a product of powers of the units; 1 for an angle.
    pub lengths: Vec<Expr>,
    /// The dimensionless numbers on which the motion depends.
    pub groups: Vec<Group>,
    /// The left sides of the equations in these units and groups; the right sides are zero.
    pub left: Vec<Expr>,
}

/// A number on which a motion depends.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The name in the dimensionless equations.
    pub name: Symbol,
    /// The definition in the parameters.
    pub definition: Expr,
    /// The meaning in words.
    pub meaning: String,
    /// The dimension of the definition, computed from the units of the parameters; it must be that
    /// of a pure number.
    pub dimension: Dimension,
}

impl Groups {
    /// The dimensionless groups of a mechanism whose units have passed their check.
    ///
    /// # Errors
    /// [`MechanicsError`] if no product of powers of the parameters is a time, or a step of algebra
    /// failed.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::mechanics::{Dimension, Groups, Mechanism};
    ///
    /// let mut pendulum = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "-m*g*L*cos(x)")?;
    /// pendulum.dissipation = "c*x'^2/2".parse()?;
    /// let units = [("m", "kg"), ("L", "m"), ("g", "m/s^2"), ("c", "N*m*s"), ("x", "rad")];
    /// let units = units.map(|(name, unit)| (name.into(), unit.parse::<Dimension>().expect("a unit"))).into();
    /// let groups = Groups::from_mechanism(&pendulum, &pendulum.equations()?, &units)?;
    /// assert_eq!(groups.left[0].to_string(), "x'' + 2*zeta*x' + sin(x)");
    /// assert_eq!(groups.groups[0].definition.to_string(), "c/(2*sqrt(g)*L^(3/2)*m)");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_mechanism(
        mechanism: &Mechanism,
        equations: &EquationsOfMotion,
        units: &BTreeMap<Symbol, Dimension>,
    ) -> Result<Self, MechanicsError> {
        // The equations are written with the sums that enter as one, each with the unit of its
        // terms.
        let combined = |expressions: &[Expr]| -> Result<Vec<Expr>, ExprError> {
            expressions.iter().map(|expression| equations.combined(expression)).collect()
        };
        let mut units = units.clone();
        for combination in &equations.combinations {
            let unit = super::dimension::dimension(&combination.meaning, &units, "sum")
                .unwrap_or_default();
            units.insert(combination.name, unit);
        }
        let left = combined(&equations.left)?;
        let symbols: BTreeSet<Symbol> = left.iter().flat_map(Expr::symbols).collect();
        let parameters: Vec<Symbol> =
            symbols.into_iter().filter(|name| equations.is_parameter(*name)).collect();
        let known = units.clone();
        let dimension_of = |name: Symbol| known.get(&name).cloned().unwrap_or_default();
        let inertia = combined(&equations.mass.concat())?;
        let stiffness = combined(std::slice::from_ref(&mechanism.potential))?;
        let mut basis = Basis::independent_among(
            &unit_candidates(&inertia, &stiffness, &parameters),
            dimension_of,
        );
        let mut sizes = Vec::new();
        for coordinate in &equations.coordinates {
            let unit = dimension_of(*coordinate);
            if basis.exponents(&unit).is_none() {
                let taken: Vec<Symbol> =
                    parameters.iter().chain(&equations.coordinates).copied().collect();
                let size = fresh(&format!("{coordinate}0"), &taken);
                basis.members.push((size, unit));
                sizes.push((*coordinate, size));
            }
        }
        let time = basis.express(&Dimension::from_exponents([0, 0, 1]))?;
        let time = time.ok_or_else(|| MechanicsError::NoTime(names(&parameters)))?;
        let mut lengths = Vec::new();
        for coordinate in &equations.coordinates {
            lengths.extend(basis.express(&dimension_of(*coordinate))?);
        }
        let mut scaling = Scaling {
            basis: &basis,
            left: Vec::new(),
            groups: Vec::new(),
            taken: mechanism
                .coordinates
                .iter()
                .copied()
                .chain([Symbol::new("t")])
                .chain(sizes.iter().map(|(_, size)| *size))
                .collect(),
        };
        let ones: BTreeMap<Symbol, Expr> =
            basis.members.iter().map(|(name, _)| (*name, Expr::one())).collect();
        for left in &left {
            scaling.left.push(
                positive_factors_out(&left.expand()?.substitute_all(&ones)?, equations)?
                    .expand()?,
            );
        }
        // A dimensionless parameter is a group already.
        let plain = |name: &&Symbol| dimension_of(**name).is_none();
        scaling.taken.extend(parameters.iter().filter(plain));
        for name in parameters.iter().filter(plain) {
            scaling.groups.push((*name, Expr::from(*name), "as given".to_owned()));
        }
        scaling.collect(equations)?;
        units.extend(sizes.iter().map(|(coordinate, size)| (*size, dimension_of(*coordinate))));
        let mut groups = Vec::new();
        let mut earlier: BTreeMap<Symbol, Expr> = BTreeMap::new();
        for (name, scaled, meaning) in &scaling.groups {
            let scaled = &scaled.substitute_all(&earlier)?;
            earlier.insert(*name, scaled.clone());
            let definition = basis.in_parameters(scaled, dimension_of)?;
            groups.push(Group {
                name: *name,
                dimension: super::dimension::dimension(&definition, &units, "group")
                    .unwrap_or_default(),
                definition,
                meaning: meaning.clone(),
            });
        }
        Ok(Self {
            parameters: parameters.len(),
            rank: basis.members.len(),
            units: basis.members.iter().map(|(name, _)| *name).collect(),
            sizes,
            combinations: equations.combinations.clone(),
            time,
            lengths,
            groups,
            left: scaling.left,
        })
    }
}

fn names(parameters: &[Symbol]) -> String {
    let names: Vec<&str> = parameters.iter().map(|name| name.name()).collect();
    names.join(", ")
}

/// Returns the parameters in the order in which they are tried as units: those of inertia, those of
/// stiffness, all others.
fn unit_candidates(inertia: &[Expr], stiffness: &[Expr], parameters: &[Symbol]) -> Vec<Symbol> {
    let [inertia, stiffness] = [inertia, stiffness]
        .map(|parts| parts.iter().flat_map(Expr::symbols).collect::<BTreeSet<_>>());
    let place = |name: &Symbol| match (inertia.contains(name), stiffness.contains(name)) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => 2,
    };
    let mut ordered = parameters.to_vec();
    ordered.sort_by_key(place);
    ordered
}

/// Takes parameters, which count as positive, out of roots: `(l*u)^(3/2) = l^(3/2)*u^(3/2)`, also
/// if `l` is common to the terms of a sum.
fn positive_factors_out(
    expression: &Expr,
    equations: &EquationsOfMotion,
) -> Result<Expr, ExprError> {
    expression.fold(|expr, children: &[Expr]| {
        let whole = expr.with_children(children)?;
        let Node::Power(base, exponent) = whole.node() else {
            return Ok(whole);
        };
        if exponent.as_number().is_none_or(Rational::is_integer) {
            return Ok(whole);
        }
        let common = equations.common(&base.terms().iter().collect::<Vec<_>>())?;
        let left = Expr::divide(base, &common)?.expand()?;
        let outside = common.factors().1.iter().map(|factor| {
            let (base, own) = factor.base_and_exponent();
            Expr::power(&base, &(&own * exponent))
        });
        let outside: Expr = outside.collect::<Result<Vec<_>, _>>()?.into_iter().product();
        Ok(outside * Expr::power(&left, exponent)?)
    })
}

/// Parameters of independent dimensions.
struct Basis {
    members: Vec<(Symbol, Dimension)>,
}

impl Basis {
    /// Takes the first parameters whose dimensions are independent.
    fn independent_among(ordered: &[Symbol], dimension_of: impl Fn(Symbol) -> Dimension) -> Self {
        let mut basis = Self { members: Vec::new() };
        for name in ordered {
            let dimension = dimension_of(*name);
            if basis.exponents(&dimension).is_none() {
                basis.members.push((*name, dimension));
            }
        }
        basis
    }

    /// Returns the exponents with which the product of the members has this dimension; `None` if
    /// there are none.
    fn exponents(&self, dimension: &Dimension) -> Option<Vec<Rational>> {
        let width = self.members.len();
        // Exact elimination with a row for each base unit, and a column for each member and for the
        // right side.
        let mut rows: Vec<Vec<Rational>> = (0..3)
            .map(|unit| {
                let members = self.members.iter().map(|(_, own)| own.exponents()[unit].clone());
                members.chain([dimension.exponents()[unit].clone()]).collect()
            })
            .collect();
        let mut done = 0;
        let mut pivots = Vec::new();
        for column in 0..width {
            let Some(found) = (done..3).find(|row| !rows[*row][column].is_zero()) else {
                continue;
            };
            rows.swap(done, found);
            let pivot = rows[done].clone();
            for (index, row) in rows.iter_mut().enumerate() {
                if index != done && !row[column].is_zero() {
                    let factor = &row[column] / &pivot[column];
                    for (entry, of_pivot) in row.iter_mut().zip(&pivot) {
                        *entry -= &factor * of_pivot;
                    }
                }
            }
            pivots.push(column);
            done += 1;
        }
        if rows[done..].iter().any(|row| !row[width].is_zero()) {
            return None;
        }
        let mut exponents = vec![Rational::zero(); width];
        for (row, column) in pivots.into_iter().enumerate() {
            exponents[column] = &rows[row][width] / &rows[row][column];
        }
        Some(exponents)
    }

    /// Returns the product of powers of the members with this dimension; `None` if there is none.
    fn express(&self, dimension: &Dimension) -> Result<Option<Expr>, ExprError> {
        let Some(exponents) = self.exponents(dimension) else {
            return Ok(None);
        };
        let power =
            |((name, _), exponent): (&(Symbol, Dimension), &Rational)| match exponent.is_zero() {
                true => Ok(Expr::one()),
                false => Expr::power(&Expr::from(*name), &Expr::number(exponent.clone())),
            };
        let factors: Result<Vec<Expr>, ExprError> =
            self.members.iter().zip(&exponents).map(power).collect();
        factors.map(|factors| Some(Expr::product(factors)))
    }

    /// Converts an expression in scaled parameters to the parameters themselves.
    fn in_parameters(
        &self,
        scaled: &Expr,
        dimension_of: impl Fn(Symbol) -> Dimension,
    ) -> Result<Expr, ExprError> {
        let mut values = BTreeMap::new();
        for name in scaled.symbols() {
            if let Some(unit) = self.express(&dimension_of(name))? {
                values.insert(name, Expr::divide(&Expr::from(name), &unit)?);
            }
        }
        // Roots of products are products of roots, since units are positive.
        let (number, factors) = scaled.factors();
        let mut product = vec![Expr::number(number)];
        for factor in factors {
            let (base, exponent) = factor.base_and_exponent();
            let base = base.substitute_all(&values)?;
            let (number, inner) = base.factors();
            product.push(Expr::power(&Expr::number(number), &exponent)?);
            for part in inner {
                let (part, own) = part.base_and_exponent();
                product.push(Expr::power(&part, &(&own * &exponent))?);
            }
        }
        Ok(Expr::product(product))
    }
}

/// The equations in units of the basis, and the groups found in them so far.
struct Scaling<'a> {
    basis: &'a Basis,
    left: Vec<Expr>,
    /// Name, definition in scaled parameters and meaning of each group.
    groups: Vec<(Symbol, Expr, String)>,
    taken: Vec<Symbol>,
}

impl Scaling<'_> {
    /// Names the coefficients of the terms in the order in which they print, the frequencies first.
    fn collect(&mut self, equations: &EquationsOfMotion) -> Result<(), ExprError> {
        let mut counted = 0;
        while let Some((product, role)) = self.next(equations) {
            let (wanted, factor, meaning) = match role {
                GroupRole::Frequency => (
                    "eta",
                    Rational::one(),
                    "frequency of the excitation over that of the unit of time",
                ),
                GroupRole::Viscous => {
                    ("zeta", Rational::new(1.into(), 2.into()), "viscous damping ratio")
                }
                GroupRole::Dry => ("alpha", Rational::one(), "dry friction"),
                GroupRole::Excitation => ("beta", Rational::one(), "excitation"),
                GroupRole::Contact => ("gamma", Rational::one(), "stiffness of the contact"),
                GroupRole::ContactDamping => ("mu", Rational::one(), "damping of the contact"),
                GroupRole::Other => {
                    counted += 1;
                    ("Pi", Rational::one(), "ratio")
                }
            };
            let own = match role {
                GroupRole::Other => Symbol::new(&format!("{wanted}{counted}")),
                _ => Symbol::new(wanted),
            };
            // Names of parameters that serve as units, or have been replaced, are not free, because
            // definitions are written with them.
            let parameters = equations.parameters();
            let taken: Vec<Symbol> =
                self.taken.iter().copied().chain(self.symbols()).chain(parameters).collect();
            // A group that consists of a single parameter of the wanted name takes over that name.
            let name = match product.symbols().len() == 1 && product.as_symbol() == Some(own) {
                true => own,
                false => fresh(own.name(), &taken),
            };
            let definition = match role {
                GroupRole::Other => Expr::product(product.factors().1.iter().cloned()),
                _ => Expr::number(factor.clone()) * &product,
            };
            self.replace(&definition, name)?;
            self.groups.push((name, definition, meaning.to_owned()));
            self.taken.push(name);
        }
        Ok(())
    }

    fn symbols(&self) -> BTreeSet<Symbol> {
        self.left.iter().flat_map(Expr::symbols).collect()
    }

    /// Whether a name is a parameter that no group has replaced yet.
    fn is_open(&self, name: Symbol, equations: &EquationsOfMotion) -> bool {
        equations.is_parameter(name)
            && !self.taken.contains(&name)
            && !self.basis.members.iter().any(|(own, _)| *own == name)
    }

    /// Returns the next product of parameters that is a coefficient, with its number, and the role
    /// that follows from the factor that it multiplies; `None` if there is none.
    fn next(&self, equations: &EquationsOfMotion) -> Option<(Expr, GroupRole)> {
        let open = |expression: &Expr| {
            expression.symbols().into_iter().any(|name| self.is_open(name, equations))
        };
        let constant = |expression: &Expr| {
            expression.symbols().into_iter().all(|name| equations.is_parameter(name))
        };
        for node in self.left.iter().flat_map(Expr::unique_nodes) {
            let Node::Function(_, arguments) = node.node() else {
                continue;
            };
            for term in arguments.iter().flat_map(Expr::terms) {
                let (number, factors) = term.factors();
                let (before, rest): (Vec<&Expr>, Vec<&Expr>) =
                    factors.iter().partition(|factor| constant(factor));
                let is_time = rest
                    .iter()
                    .all(|factor| factor.as_symbol().is_some_and(|name| name.name() == "t"));
                let product = Expr::product(
                    [Expr::number(number.abs())].into_iter().chain(before.into_iter().cloned()),
                );
                if !rest.is_empty() && is_time && open(&product) {
                    return Some((product, GroupRole::Frequency));
                }
            }
        }
        for term in self.left.iter().flat_map(Expr::terms) {
            let (number, factors) = term.factors();
            let (before, rest): (Vec<&Expr>, Vec<&Expr>) =
                factors.iter().partition(|factor| constant(factor));
            let product = Expr::product(
                [Expr::number(number.abs())].into_iter().chain(before.into_iter().cloned()),
            );
            if open(&product) {
                return Some((
                    product,
                    GroupRole::from_factor(&Expr::product(rest.into_iter().cloned())),
                ));
            }
        }
        // Parameters inside other functions, such as the position of a barrier, are taken one by
        // one.
        let name = self.symbols().into_iter().find(|name| self.is_open(*name, equations))?;
        Some((Expr::from(name), GroupRole::Other))
    }

    /// Replaces the definition of a group by its name: eliminates one of the parameters in it.
    fn replace(&mut self, definition: &Expr, name: Symbol) -> Result<(), ExprError> {
        let (number, factors) = definition.factors();
        let parameter = |factor: &Expr| {
            let (base, exponent) = factor.base_and_exponent();
            Some((
                base.as_symbol().filter(|name| !self.taken.contains(name))?,
                exponent.as_number()?.clone(),
            ))
        };
        let parameters: Vec<(Symbol, Rational)> = factors.iter().filter_map(parameter).collect();
        // A parameter that occurs nowhere else is preferred, since it then disappears; next one
        // with the exponent 1 or -1, which is replaced without a root.
        let occurrences = |name: Symbol| {
            let terms = self.left.iter().flat_map(Expr::terms);
            terms.filter(|term| term.contains(name)).count()
        };
        let simplest = parameters.iter().min_by_key(|(name, exponent)| {
            (occurrences(*name), !exponent.abs().is_one(), exponent.is_negative())
        });
        let Some((replaced, exponent)) = simplest.cloned() else {
            return Ok(());
        };
        let others = factors
            .iter()
            .filter(|factor| factor.base_and_exponent().0.as_symbol() != Some(replaced));
        let others = Expr::product([Expr::number(number)].into_iter().chain(others.cloned()));
        let value = Expr::divide(&Expr::from(name), &others)?;
        let inverse = Rational::one() / exponent;
        let (number, inner) = value.factors();
        let mut product = vec![Expr::power(&Expr::number(number), &Expr::number(inverse.clone()))?];
        for part in inner {
            let (part, own) = part.base_and_exponent();
            product.push(Expr::power(&part, &(&own * &Expr::number(inverse.clone())))?);
        }
        let value = Expr::product(product);
        for left in &mut self.left {
            *left = left.substitute(replaced, &value)?.expand()?;
        }
        Ok(())
    }
}

/// The role of a group, by the factor that it multiplies.
#[derive(Clone, Copy, PartialEq)]
enum GroupRole {
    Frequency,
    Viscous,
    Dry,
    Excitation,
    Contact,
    ContactDamping,
    Other,
}

impl GroupRole {
    fn from_factor(before: &Expr) -> Self {
        let has = |function: Function| before.contains_function(function);
        let velocity = before.symbols().into_iter().any(|name| name.primes() == 1);
        let time = before.symbols().into_iter().any(|name| name.name() == "t");
        match before.as_symbol() {
            Some(name) if name.primes() == 1 => Self::Viscous,
            _ if time => Self::Excitation,
            _ if has(Function::Step) && velocity => Self::ContactDamping,
            _ if has(Function::Step) => Self::Contact,
            _ if matches!(before.node(), Node::Function(Function::Sign, _)) => Self::Dry,
            _ => Self::Other,
        }
    }
}
