//! Measurements made up, with the noise of a sensor: what `lindstedt fit` finds the law of.
//!
//! ```text
//! cargo run --release --example measurements pendulum > examples/fit/pendulum.csv
//! cargo run --release --example measurements backbone > examples/fit/backbone.csv
//! cargo run --release --example measurements response > examples/fit/response.csv
//! cargo run --release --example measurements impacts > examples/fit/impacts.csv
//! ```

use lindstedt::numeric::ode::{IntegrationOptions, State, integrate};
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::wall::Wall;
use lindstedt::{Options, Oscillator, judge, solve};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("backbone") => backbone(),
        Some("response") => response(),
        Some("impacts") => impacts(),
        _ => pendulum(),
    }
}

/// The sum of twelve equal chances, which is nearly normal, with the standard deviation 1.
fn noise(random: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
}

/// A pendulum with viscous damping and dry friction, 50 times a second for a minute.
fn pendulum() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = Oscillator::parse("x'' + 2*zeta*x' + alpha*sgn(x') + sin(x) = 0")?;
    let mut request = TrajectoryRequest::of_equation(&pendulum);
    request.values.insert("zeta".into(), 0.004);
    request.values.insert("alpha".into(), 0.003);
    request.begin("x".into(), 1.0)?;
    // The unit of time is the square root of length over gravity, here a tenth of a second.
    request.duration = 600.0;
    let motion = request.follow()?;
    let mut random = ChaCha8Rng::seed_from_u64(1);
    println!(
        "# A pendulum with zeta = 0.004, alpha = 0.003, w = 10 1/s, and noise of 0.3 degrees."
    );
    println!("t (s),angle (deg)");
    for sample in 0..3000 {
        let time = f64::from(sample) / 50.0;
        let state = motion.states_at(10.0 * time).ok_or("the motion ended")?;
        println!("{time:.2},{:.2}", state[0].to_degrees() + 0.3 * noise(&mut random));
    }
    Ok(())
}

/// The frequency of a cubic spring against its amplitude.
fn backbone() -> Result<(), Box<dyn std::error::Error>> {
    let spring = Oscillator::parse("x'' + 2500*x + 4000*x^3 = 0")?;
    let solution = solve(&spring, &Options::default())?;
    println!(
        "# x'' + w^2*x + beta*x^3 = 0 with w = 50 1/s and beta = 4000, to a thousandth of a hertz."
    );
    println!("amplitude,frequency (Hz)");
    for row in 1..=20 {
        let amplitude = f64::from(row) / 20.0;
        let judged = judge(&spring, &solution, &format!("A = {row}/20").parse()?, 1.0)?;
        println!("{amplitude:.2},{:.3}", judged.true_frequency / std::f64::consts::TAU);
    }
    Ok(())
}

/// A driven oscillator with a cubic spring, swept up and down through both folds of its response: the first
/// harmonic, once the motion has settled.
fn response() -> Result<(), Box<dyn std::error::Error>> {
    const HARMONIC: u32 = 200;
    let up = (0..22).map(|step| 0.6 + 0.04 * f64::from(step));
    let down = (0..13).map(|step| 2.0 - 0.05 * f64::from(step));
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let options = IntegrationOptions::default();
    println!(
        "# x'' + c*x' + k*x + b*x^3 = F*cos(Omega*t) with c = 0.1, k = 1, b = 0.5, F = 0.3, swept up, then down."
    );
    println!("Omega,amplitude,phase (deg)");
    let (mut x, mut v) = (0.0, 0.0);
    for omega in up.chain(down) {
        let acceleration =
            |t: f64, x: f64, v: f64| 0.3 * (omega * t).cos() - 0.1 * v - x - 0.5 * x.powi(3);
        let period = std::f64::consts::TAU / omega;
        let settled = 60.0 * period;
        let motion =
            integrate(acceleration, State { t: 0.0, x, v }, settled + period, &[], &options)?;
        let (mut cosine, mut sine) = (0.0, 0.0);
        for sample in 0..HARMONIC {
            let part = f64::from(sample) / f64::from(HARMONIC);
            let (x, _) =
                motion.phase_point_at(settled + part * period).ok_or("the motion ended")?;
            let (s, c) = (std::f64::consts::TAU * part).sin_cos();
            cosine += 2.0 * x * c / f64::from(HARMONIC);
            sine += 2.0 * x * s / f64::from(HARMONIC);
        }
        (x, v) = (motion.end().x, motion.end().v);
        let amplitude = cosine.hypot(sine) + 2e-3 * noise(&mut random);
        let phase = sine.atan2(cosine).to_degrees() + 0.3 * noise(&mut random);
        println!("{omega:.2},{amplitude:.4},{phase:.2}");
    }
    Ok(())
}

/// A ball that bounces on a table.
fn impacts() -> Result<(), Box<dyn std::error::Error>> {
    let ball = Oscillator::parse("x'' + 9.81 = 0")?;
    let walls = Wall::parse("x > 0", &"0.86".parse()?)?;
    let mut request = TrajectoryRequest::of_equation(&ball).with_walls(walls);
    request.begin("x".into(), 0.5)?;
    request.duration = 4.0;
    let motion = request.follow()?;
    let mut random = ChaCha8Rng::seed_from_u64(2);
    println!("# When a ball touched a table: restitution 0.86, times good to 0.2 ms.");
    println!("t (s)");
    for impact in motion.walls.impacts.iter().take(14) {
        println!("{:.5}", impact.time + 2e-4 * noise(&mut random));
    }
    Ok(())
}
