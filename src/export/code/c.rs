//! C99, with the functions of `math.h`. A number that does not exist is `NAN`.

use super::{Base, Break, Exponent, Syntax, Text, UsedRoutines};
use crate::expr::Function;

pub(super) const SYNTAX: Syntax = Syntax {
    name: "c",
    comment: "//",
    // Keywords; names of `math.h`, which compilers warn of; macros of compilers.
    reserved: &[
        "auto",
        "break",
        "case",
        "char",
        "const",
        "continue",
        "default",
        "do",
        "double",
        "else",
        "enum",
        "extern",
        "float",
        "for",
        "goto",
        "if",
        "inline",
        "int",
        "long",
        "register",
        "restrict",
        "return",
        "short",
        "signed",
        "sizeof",
        "static",
        "struct",
        "switch",
        "typedef",
        "union",
        "unsigned",
        "void",
        "volatile",
        "while",
        "alignas",
        "alignof",
        "asm",
        "bool",
        "constexpr",
        "false",
        "linux",
        "nullptr",
        "thread_local",
        "true",
        "typeof",
        "unix",
        "copysign",
        "div",
        "drem",
        "erf",
        "exp2",
        "fabs",
        "fdim",
        "floor",
        "fma",
        "fmax",
        "fmin",
        "fmod",
        "gamma",
        "hypot",
        "j0",
        "j1",
        "jn",
        "lgamma",
        "logb",
        "main",
        "pow",
        "rint",
        "round",
        "signgam",
        "sqrt",
        "tgamma",
        "trunc",
        "y0",
        "y1",
        "yn",
        "NAN",
        "INFINITY",
        "HUGE_VAL",
        "HUGE_VALF",
        "HUGE_VALL",
        "M_1_PI",
        "M_2_PI",
        "M_2_SQRTPI",
        "M_E",
        "M_LN10",
        "M_LN2",
        "M_LOG10E",
        "M_LOG2E",
        "M_PI",
        "M_PI_2",
        "M_PI_4",
        "M_SQRT1_2",
        "M_SQRT2",
        "MATH_ERREXCEPT",
        "MATH_ERRNO",
        "FP_ILOGB0",
        "FP_ILOGBNAN",
        "FP_INFINITE",
        "FP_NAN",
        "FP_NORMAL",
        "FP_SUBNORMAL",
        "FP_ZERO",
        "math_errhandling",
        "PI",
        "DOMAIN",
        "OVERFLOW",
        "PLOSS",
        "SING",
        "TLOSS",
        "UNDERFLOW",
    ],
    point: ".0",
    pi: "PI",
    operators: ["*", "/"],
    between_values: ["*", "/"],
    power: |Base { inside, .. }, exponent| match exponent {
        Exponent::Whole(number) | Exponent::Real(number) => format!("pow({inside}, {number})"),
        Exponent::Half => format!("sqrt({inside})"),
        Exponent::OddRoot(number, true) => {
            format!("copysign(pow(fabs({inside}), {number}), {inside})")
        }
        Exponent::OddRoot(number, false) => format!("pow(fabs({inside}), {number})"),
    },
    function,
    helper,
    variable: |name, _| [format!("const double {name} = "), ";".to_owned()],
    result: ["return ", ";"],
    size: |name| format!("{name} = fabs({name});"),
    unused: Some(|name| format!("(void){name};")),
    positive: |name, _, reason| format!("if (!({name} > 0.0)) {{\n    return NAN; // {reason}\n}}"),
    breaks: Break::BeforeSigns,
    beginning,
    routine,
};

fn function(function: Function) -> &'static str {
    match function {
        Function::Absolute => "fabs",
        Function::Maximum => "fmax",
        Function::Minimum => "fmin",
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
        Function::Gamma => "tgamma",
        other => other.name(),
    }
}

fn beginning(used: &UsedRoutines) -> String {
    let pi = match used.has("PI") {
        true => "\nstatic const double PI = 3.14159265358979323846;\n",
        false => "",
    };
    format!("#include <math.h>\n{pi}")
}

fn routine(text: &Text) -> String {
    let arguments: Vec<String> =
        text.arguments.iter().map(|name| format!("double {name}")).collect();
    let arguments = if arguments.is_empty() { "void".to_owned() } else { arguments.join(", ") };
    let head = format!("// {}.\ndouble {}({arguments})\n{{\n", text.about, text.name);
    let lines = text.lines.iter().map(|line| format!("    {line}\n"));
    std::iter::once(head).chain(lines).chain(["}\n".to_owned()]).collect()
}

fn helper(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Sign => {
            "// -1, 0 or 1.
static double sign(double u)
{
    return (double)((u > 0.0) - (u < 0.0));
}
"
        }
        Function::Step => {
            "// 1 where u is positive, 0 elsewhere.
static double heaviside(double u)
{
    return u > 0.0 ? 1.0 : 0.0;
}
"
        }
        Function::BesselJ0 => {
            "// The Bessel function of the first kind, a mean over half a turn; for |u| < 1e7.
static double bessel_j0(double u)
{
    if (!(fabs(u) < 1e7)) {
        return NAN;
    }
    const int count = 32 + (int)fabs(u);
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        sum += cos(u*sin(PI*(k + 0.5)/count));
    }
    return sum/count;
}
"
        }
        Function::BesselJ1 => {
            "// The Bessel function of the first kind and of order one, a mean over half a turn; for |u| < 1e7.
static double bessel_j1(double u)
{
    if (!(fabs(u) < 1e7)) {
        return NAN;
    }
    const int count = 32 + (int)fabs(u);
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        const double sine = sin(PI*(k + 0.5)/count);
        sum += sine*sin(u*sine);
    }
    return sum/count;
}
"
        }
        Function::BesselI0 => {
            "// The modified Bessel function of the first kind, a mean over half a turn; for |u| < 1e7.
static double bessel_i0(double u)
{
    if (!(fabs(u) < 1e7)) {
        return NAN;
    }
    const int count = 32 + (int)fabs(u);
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        sum += cosh(u*cos(PI*(k + 0.5)/count));
    }
    return sum/count;
}
"
        }
        Function::BesselI1 => {
            "// The modified Bessel function of the first kind and of order one, a mean over half a turn; for |u| < 1e7.
static double bessel_i1(double u)
{
    if (!(fabs(u) < 1e7)) {
        return NAN;
    }
    const int count = 32 + (int)fabs(u);
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        const double cosine = cos(PI*(k + 0.5)/count);
        sum += cosine*sinh(u*cosine);
    }
    return sum/count;
}
"
        }
        Function::EllipticK => {
            "// The complete elliptic integral of the first kind, m = k^2 < 1, by the arithmetic-geometric mean.
static double elliptic_k(double m)
{
    if (!(m < 1.0)) {
        return NAN;
    }
    double a = 1.0, b = sqrt(1.0 - m);
    for (int k = 0; k < 40; k++) {
        const double mean = (a + b)/2.0;
        b = sqrt(a*b);
        a = mean;
    }
    return PI/(a + b);
}
"
        }
        Function::JacobiSn => {
            "// The elliptic functions sn, cn and dn of Jacobi, m = k^2 < 1, by the arithmetic-geometric mean.
static double jacobi_functions(double u, double m, int which)
{
    if (!(m < 1.0)) {
        return NAN;
    }
    const double scale = m < 0.0 ? sqrt(1.0 - m) : 1.0;
    const double p = m < 0.0 ? -m/(1.0 - m) : m;
    double a = 1.0, b = sqrt(1.0 - p), ratios[8];
    for (int k = 0; k < 8; k++) {
        ratios[k] = (a - b)/(a + b);
        const double mean = (a + b)/2.0;
        b = sqrt(a*b);
        a = mean;
    }
    double phi = 256.0*a*u*scale;
    for (int k = 7; k >= 0; k--) {
        phi = (phi + asin(ratios[k]*sin(phi)))/2.0;
    }
    const double s = sin(phi), c = cos(phi), d = sqrt(c*c + (1.0 - p)*s*s);
    if (m < 0.0) {
        return which == 0 ? s/(d*scale) : which == 1 ? c/d : 1.0/d;
    }
    return which == 0 ? s : which == 1 ? c : d;
}

// The elliptic function sn of Jacobi.
static double jacobi_sn(double u, double m)
{
    return jacobi_functions(u, m, 0);
}
"
        }
        Function::JacobiCn => {
            "// The elliptic function cn of Jacobi.
static double jacobi_cn(double u, double m)
{
    return jacobi_functions(u, m, 1);
}
"
        }
        Function::JacobiDn => {
            "// The elliptic function dn of Jacobi.
static double jacobi_dn(double u, double m)
{
    return jacobi_functions(u, m, 2);
}
"
        }
        _ => return None,
    })
}
