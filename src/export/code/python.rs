//! Python 3, with the module `math`; arrays element by element with NumPy. A number that does not
//! exist is a `ValueError`.

use super::{Base, Break, Exponent, Syntax, Text, UsedRoutines};
use crate::expr::Function;

pub(super) const SYNTAX: Syntax = Syntax {
    name: "python",
    comment: "#",
    reserved: &[
        "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class",
        "continue", "def", "del", "elif", "else", "except", "finally", "for", "from", "global",
        "if", "import", "in", "is", "lambda", "nonlocal", "not", "or", "pass", "raise", "return",
        "try", "while", "with", "yield", "abs", "copysign", "max", "min", "pi", "pow", "sqrt",
    ],
    point: "",
    pi: "pi",
    operators: ["*", "/"],
    between_values: ["*", "/"],
    power: |Base { inside, operand, .. }, exponent| match exponent {
        Exponent::Whole(number) => format!("{operand}**{number}"),
        Exponent::Half => format!("sqrt({inside})"),
        Exponent::OddRoot(number, true) => {
            format!("copysign(pow(abs({inside}), {number}), {inside})")
        }
        Exponent::OddRoot(number, false) => format!("pow(abs({inside}), {number})"),
        Exponent::Real(number) => format!("pow({inside}, {number})"),
    },
    function,
    helper,
    variable: |name, _| [format!("{name} = "), String::new()],
    result: ["return ", ""],
    size: |name| format!("{name} = abs({name})"),
    unused: None,
    positive: |name, _, reason| format!("if not {name} > 0:\n    raise ValueError(\"{reason}\")"),
    breaks: Break::InParentheses,
    beginning,
    routine,
};

fn function(function: Function) -> &'static str {
    match function {
        Function::Absolute => "abs",
        Function::Sign => "sign",
        Function::Step => "heaviside",
        Function::BesselJ0 => "bessel_j0",
        Function::BesselJ1 => "bessel_j1",
        Function::BesselI0 => "bessel_i0",
        Function::BesselI1 => "bessel_i1",
        Function::EllipticK => "elliptic_k",
        Function::JacobiSn => "jacobi_sn",
        Function::JacobiCn => "jacobi_cn",
        Function::JacobiDn => "jacobi_dn",
        Function::Gamma => "gamma",
        other => other.name(),
    }
}

/// The imports: `pow` of the module raises a `ValueError` where the built-in one would return a
/// complex number.
fn beginning(used: &UsedRoutines) -> String {
    /// A loop over the elements, in which each finds its own error and its own branch.
    const ELEMENTWISE: &str = r#"from functools import wraps


def elementwise(function):
    """Takes arrays and sequences too, element by element, as NumPy does; numbers need no NumPy."""
    @wraps(function)
    def broadcast(*arguments, **named):
        values = [*arguments, *named.values()]
        if not any(hasattr(value, "__len__") for value in values):
            return function(*arguments, **named)
        from numpy import vectorize
        return vectorize(function, otypes=[float])(*arguments, **named)
    return broadcast


"#;

    const MODULE: [&str; 18] = [
        "acos", "asin", "asinh", "atan", "ceil", "copysign", "cos", "cosh", "exp", "gamma", "log",
        "pi", "pow", "sin", "sinh", "sqrt", "tan", "tanh",
    ];
    let imported: Vec<&str> = MODULE.into_iter().filter(|name| used.has(name)).collect();
    let imports = match imported.is_empty() {
        true => String::new(),
        false => format!("from math import {}\n", imported.join(", ")),
    };
    ELEMENTWISE.replacen("\n\n", &format!("\n{imports}\n"), 1).trim_end().to_owned() + "\n\n"
}

fn routine(text: &Text) -> String {
    let head = format!("@elementwise\ndef {}({}):\n", text.name, text.arguments.join(", "));
    let about = format!("    \"\"\"{}.\"\"\"\n", text.about);
    let lines = text.lines.iter().map(|line| format!("    {line}\n"));
    [head, about].into_iter().chain(lines).chain(["\n".to_owned()]).collect()
}

fn helper(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Sign => {
            r#"def sign(u):
    """-1, 0 or 1."""
    return (u > 0) - (u < 0)

"#
        }
        Function::Step => {
            r#"def heaviside(u):
    """1 where u is positive, 0 elsewhere."""
    return 1 if u > 0 else 0

"#
        }
        Function::BesselJ0 => {
            r#"def bessel_j0(u):
    """The Bessel function of the first kind, a mean over half a turn."""
    count = 32 + ceil(abs(u))
    angles = (pi*(k + 0.5)/count for k in range(count))
    return sum(cos(u*sin(angle)) for angle in angles)/count

"#
        }
        Function::BesselJ1 => {
            r#"def bessel_j1(u):
    """The Bessel function of the first kind and of order one, a mean over half a turn."""
    count = 32 + ceil(abs(u))
    angles = (pi*(k + 0.5)/count for k in range(count))
    return sum(sin(angle)*sin(u*sin(angle)) for angle in angles)/count

"#
        }
        Function::BesselI0 => {
            r#"def bessel_i0(u):
    """The modified Bessel function of the first kind, a mean over half a turn."""
    count = 32 + ceil(abs(u))
    angles = (pi*(k + 0.5)/count for k in range(count))
    return sum(cosh(u*cos(angle)) for angle in angles)/count

"#
        }
        Function::BesselI1 => {
            r#"def bessel_i1(u):
    """The modified Bessel function of the first kind and of order one, a mean over half a turn."""
    count = 32 + ceil(abs(u))
    angles = (pi*(k + 0.5)/count for k in range(count))
    return sum(cos(angle)*sinh(u*cos(angle)) for angle in angles)/count

"#
        }
        Function::EllipticK => {
            r#"def elliptic_k(m):
    """The complete elliptic integral of the first kind, m = k^2 < 1, by the arithmetic-geometric mean."""
    if not m < 1:
        raise ValueError("K(m) has no value for m >= 1")
    a, b = 1.0, sqrt(1 - m)
    for _ in range(40):
        a, b = (a + b)/2, sqrt(a*b)
    return pi/(a + b)

"#
        }
        Function::JacobiSn => {
            r#"def jacobi_functions(u, m):
    """The elliptic functions sn, cn and dn of Jacobi, m = k^2 < 1, by the arithmetic-geometric mean."""
    if not m < 1:
        raise ValueError("sn, cn and dn have no value for m >= 1 here")
    if m < 0:
        scale = sqrt(1 - m)
        s, c, d = jacobi_functions(u*scale, -m/(1 - m))
        return s/(d*scale), c/d, 1/d
    a, b = 1.0, sqrt(1 - m)
    ratios = []
    for _ in range(8):
        ratios.append((a - b)/(a + b))
        a, b = (a + b)/2, sqrt(a*b)
    phi = 256*a*u
    for ratio in reversed(ratios):
        phi = (phi + asin(ratio*sin(phi)))/2
    s, c = sin(phi), cos(phi)
    return s, c, sqrt(c*c + (1 - m)*s*s)


def jacobi_sn(u, m):
    """The elliptic function sn of Jacobi."""
    return jacobi_functions(u, m)[0]

"#
        }
        Function::JacobiCn => {
            r#"def jacobi_cn(u, m):
    """The elliptic function cn of Jacobi."""
    return jacobi_functions(u, m)[1]

"#
        }
        Function::JacobiDn => {
            r#"def jacobi_dn(u, m):
    """The elliptic function dn of Jacobi."""
    return jacobi_functions(u, m)[2]

"#
        }
        _ => return None,
    })
}
