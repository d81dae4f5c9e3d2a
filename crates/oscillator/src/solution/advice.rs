//! Advice after a refusal. The library names options; a program puts its own spelling in their
//! place.

use std::fmt;

use super::note::Position;
use super::{AmplitudeConvention, Degrees, Method};
use crate::symbol::Symbol;

/// A sentence with options in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice(Vec<AdvicePart>);

#[derive(Clone, Debug, PartialEq)]
enum AdvicePart {
    Words(String),
    Choose(Setting),
}

/// An option with its value.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Setting {
    /// The method.
    Method(Method),
    /// The order.
    Order(u32),
    /// The degrees of an approximant.
    Degrees(Degrees),
    /// The meaning of the amplitude.
    Amplitude(AmplitudeConvention),
    /// The small parameter.
    Small(Symbol),
    /// A Taylor polynomial in place of the force, of any degree.
    Taylor,
    /// The equilibrium about which the motion swings.
    About {
        /// The coordinate.
        coordinate: Symbol,
        /// Its value there.
        position: Position,
    },
    /// Values for parameters and amplitude.
    Values,
    /// A resonance, Omega : omega0.
    Resonance(u32, u32),
}

impl Advice {
    /// A sentence without options, or the beginning of one.
    pub fn words(words: impl Into<String>) -> Self {
        Self(vec![AdvicePart::Words(words.into())])
    }

    /// The sentence with an option at its end.
    #[must_use]
    pub fn choose(mut self, setting: Setting) -> Self {
        self.0.push(AdvicePart::Choose(setting));
        self
    }

    /// The sentence with words at its end.
    #[must_use]
    pub fn then(mut self, words: impl Into<String>) -> Self {
        self.0.push(AdvicePart::Words(words.into()));
        self
    }

    /// The sentence with each option spelt by `option`.
    pub fn spelt(&self, option: impl Fn(&Setting) -> String) -> String {
        let part = |part: &AdvicePart| match part {
            AdvicePart::Words(words) => words.clone(),
            AdvicePart::Choose(setting) => option(setting),
        };
        self.0.iter().map(part).collect()
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.spelt(ToString::to_string))
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Method(method) => write!(formatter, "method {}", method.name()),
            Self::Order(order) => write!(formatter, "order {order}"),
            Self::Degrees(degrees) => write!(formatter, "degrees {}", degrees.separated()),
            Self::Amplitude(convention) => write!(formatter, "amplitude {}", convention.name()),
            Self::Small(name) => write!(formatter, "small {name}"),
            Self::Taylor => formatter.write_str("a Taylor degree"),
            Self::About { coordinate, position } => {
                write!(formatter, "about {coordinate}={position}")
            }
            Self::Values => formatter.write_str("values"),
            Self::Resonance(driving, linear) => write!(formatter, "resonance {driving}:{linear}"),
        }
    }
}
