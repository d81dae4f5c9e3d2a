//! Rust, with the standard library. A number that does not exist is NaN.

use super::{Base, Break, Exponent, Syntax, Text, UsedRoutines};
use crate::expr::Function;

pub(super) const SYNTAX: Syntax = Syntax {
    name: "rust",
    comment: "//!",
    reserved: &[
        "as", "async", "await", "break", "const", "continue", "crate", "dyn", "else", "enum",
        "extern", "false", "fn", "for", "if", "impl", "in", "let", "loop", "match", "mod", "move",
        "mut", "pub", "ref", "return", "self", "Self", "static", "struct", "super", "trait",
        "true", "type", "unsafe", "use", "where", "while", "abstract", "become", "box", "do",
        "final", "gen", "macro", "override", "priv", "try", "typeof", "unsized", "virtual",
        "yield", "f64", "PI", "_",
    ],
    point: ".0",
    pi: "PI",
    operators: [" * ", " / "],
    between_values: [" * ", " / "],
    power,
    function,
    helper,
    // A literal number has no definite type.
    variable: |name, literal| {
        let kind = if literal { ": f64" } else { "" };
        [format!("let {name}{kind} = "), ";".to_owned()]
    },
    result: ["", ""],
    size: |name| format!("let {name} = {name}.abs();"),
    unused: Some(|name| format!("let _ = {name};")),
    positive: |name, _, reason| {
        format!("if {name}.is_nan() || {name} <= 0.0 {{\n    return f64::NAN; // {reason}\n}}")
    },
    breaks: Break::BeforeSigns,
    beginning,
    routine,
};

/// A power. That of a literal number cannot be a method call, because a literal has no definite
/// type.
fn power(base: &Base, exponent: Exponent) -> String {
    let Base { inside, operand, literal } = base;
    let call = |method: &str, argument: &str| match (literal, argument) {
        (true, "") => format!("f64::{method}({inside})"),
        (true, _) => format!("f64::{method}({inside}, {argument})"),
        (false, _) => format!("{operand}.{method}({argument})"),
    };
    match exponent {
        Exponent::Whole(number) => call("powi", number),
        Exponent::Half => call("sqrt", ""),
        Exponent::OddRoot(number, true) => {
            format!("{operand}.abs().powf({number}).copysign({inside})")
        }
        Exponent::OddRoot(number, false) => format!("{operand}.abs().powf({number})"),
        Exponent::Real(number) => call("powf", number),
    }
}

fn function(function: Function) -> &'static str {
    match function {
        Function::Sin => ".sin",
        Function::Cos => ".cos",
        Function::Tan => ".tan",
        Function::Sinh => ".sinh",
        Function::Cosh => ".cosh",
        Function::Tanh => ".tanh",
        Function::Asin => ".asin",
        Function::Acos => ".acos",
        Function::Atan => ".atan",
        Function::Asinh => ".asinh",
        Function::Exp => ".exp",
        Function::Log => ".ln",
        Function::Absolute => ".abs",
        Function::Maximum => ".max",
        Function::Minimum => ".min",
        Function::Sign => "sign",
        Function::Step => "heaviside",
        Function::BesselJ0 => "bessel_j0",
        Function::BesselJ1 => "bessel_j1",
        Function::BesselI0 => "bessel_i0",
        Function::BesselI1 => "bessel_i1",
        Function::Gamma => "gamma_function",
        Function::EllipticK => "elliptic_k",
        Function::JacobiSn => "jacobi_sn",
        Function::JacobiCn => "jacobi_cn",
        Function::JacobiDn => "jacobi_dn",
    }
}

/// Names keep the spelling of the formulas, so that lints for names are switched off.
fn beginning(used: &UsedRoutines) -> String {
    let signatures =
        || used.text.lines().filter(|line| line.contains("fn ") || line.contains("let "));
    let name = |line: &str| {
        let names = line.split(" = ").next().unwrap_or(line).split(" -> ").next().unwrap_or(line);
        names.chars().any(|letter| letter.is_ascii_uppercase())
    };
    let capitals = signatures().any(name);
    let allow = if capitals { "#![allow(non_snake_case)]\n\n" } else { "" };
    let pi = if used.has("PI") { "use std::f64::consts::PI;\n\n" } else { "" };
    format!("{allow}{pi}").trim_end_matches('\n').to_owned()
        + if capitals || !pi.is_empty() { "\n" } else { "" }
}

fn routine(text: &Text) -> String {
    let arguments: Vec<String> = text.arguments.iter().map(|name| format!("{name}: f64")).collect();
    let head =
        format!("/// {}.\npub fn {}({}) -> f64 {{\n", text.about, text.name, arguments.join(", "));
    let lines = text.lines.iter().map(|line| format!("    {line}\n"));
    std::iter::once(head).chain(lines).chain(["}\n".to_owned()]).collect()
}

fn helper(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Sign => {
            "/// -1, 0 or 1.
fn sign(u: f64) -> f64 {
    if u == 0.0 { 0.0 } else { u.signum() }
}
"
        }
        Function::Step => {
            "/// 1 where u is positive, 0 elsewhere.
fn heaviside(u: f64) -> f64 {
    if u > 0.0 { 1.0 } else { 0.0 }
}
"
        }
        Function::BesselJ0 => {
            "/// The Bessel function of the first kind, a mean over half a turn; for |u| < 1e7.
fn bessel_j0(u: f64) -> f64 {
    if u.is_nan() || u.abs() >= 1e7 {
        return f64::NAN;
    }
    let count = 32 + u.abs() as i32;
    let angle = |k: i32| PI * (f64::from(k) + 0.5) / f64::from(count);
    let sum: f64 = (0..count).map(|k| (u * angle(k).sin()).cos()).sum();
    sum / f64::from(count)
}
"
        }
        Function::BesselJ1 => {
            "/// The Bessel function of the first kind and of order one, a mean over half a turn; for |u| < 1e7.
fn bessel_j1(u: f64) -> f64 {
    if u.is_nan() || u.abs() >= 1e7 {
        return f64::NAN;
    }
    let count = 32 + u.abs() as i32;
    let sine = |k: i32| (PI * (f64::from(k) + 0.5) / f64::from(count)).sin();
    let sum: f64 = (0..count).map(|k| sine(k) * (u * sine(k)).sin()).sum();
    sum / f64::from(count)
}
"
        }
        Function::BesselI0 => {
            "/// The modified Bessel function of the first kind, a mean over half a turn; for |u| < 1e7.
fn bessel_i0(u: f64) -> f64 {
    if u.is_nan() || u.abs() >= 1e7 {
        return f64::NAN;
    }
    let count = 32 + u.abs() as i32;
    let angle = |k: i32| PI * (f64::from(k) + 0.5) / f64::from(count);
    let sum: f64 = (0..count).map(|k| (u * angle(k).cos()).cosh()).sum();
    sum / f64::from(count)
}
"
        }
        Function::BesselI1 => {
            "/// The modified Bessel function of the first kind and of order one, a mean over half a turn; for |u| < 1e7.
fn bessel_i1(u: f64) -> f64 {
    if u.is_nan() || u.abs() >= 1e7 {
        return f64::NAN;
    }
    let count = 32 + u.abs() as i32;
    let cosine = |k: i32| (PI * (f64::from(k) + 0.5) / f64::from(count)).cos();
    let sum: f64 = (0..count).map(|k| cosine(k) * (u * cosine(k)).sinh()).sum();
    sum / f64::from(count)
}
"
        }
        Function::Gamma => {
            "/// The Gamma function, by Lanczos' approximation.
fn gamma_function(u: f64) -> f64 {
    const TERMS: [f64; 9] = [
        0.99999999999980993,
        676.5203681218851,
        -1259.1392167224028,
        771.32342877765313,
        -176.61502916214059,
        12.507343278686905,
        -0.13857109526572012,
        9.9843695780195716e-6,
        1.5056327351493116e-7,
    ];
    if u < 0.5 {
        return PI / ((PI * u).sin() * gamma_function(1.0 - u));
    }
    let terms = TERMS.iter().enumerate().skip(1);
    let sum: f64 = TERMS[0] + terms.map(|(k, term)| term / (u - 1.0 + k as f64)).sum::<f64>();
    let t = u + 6.5;
    (2.0 * PI).sqrt() * t.powf(u - 0.5) * (-t).exp() * sum
}
"
        }
        Function::EllipticK => {
            "/// The complete elliptic integral of the first kind, m = k^2 < 1, by the arithmetic-geometric mean.
fn elliptic_k(m: f64) -> f64 {
    if m.is_nan() || m >= 1.0 {
        return f64::NAN;
    }
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    for _ in 0..40 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    PI / (a + b)
}
"
        }
        Function::JacobiSn => {
            "/// The elliptic functions sn, cn and dn of Jacobi, m = k^2 < 1, by the arithmetic-geometric mean.
fn jacobi_functions(u: f64, m: f64) -> [f64; 3] {
    if m.is_nan() || m >= 1.0 {
        return [f64::NAN; 3];
    }
    if m < 0.0 {
        let scale = (1.0 - m).sqrt();
        let [s, c, d] = jacobi_functions(u * scale, -m / (1.0 - m));
        return [s / (d * scale), c / d, 1.0 / d];
    }
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    let mut ratios = [0.0; 8];
    for ratio in &mut ratios {
        *ratio = (a - b) / (a + b);
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    let mut phi: f64 = 256.0 * a * u;
    for ratio in ratios.iter().rev() {
        phi = (phi + (ratio * phi.sin()).asin()) / 2.0;
    }
    let (s, c) = phi.sin_cos();
    [s, c, (c * c + (1.0 - m) * s * s).sqrt()]
}

/// The elliptic function sn of Jacobi.
fn jacobi_sn(u: f64, m: f64) -> f64 {
    jacobi_functions(u, m)[0]
}
"
        }
        Function::JacobiCn => {
            "/// The elliptic function cn of Jacobi.
fn jacobi_cn(u: f64, m: f64) -> f64 {
    jacobi_functions(u, m)[1]
}
"
        }
        Function::JacobiDn => {
            "/// The elliptic function dn of Jacobi.
fn jacobi_dn(u: f64, m: f64) -> f64 {
    jacobi_functions(u, m)[2]
}
"
        }
        _ => return None,
    })
}
