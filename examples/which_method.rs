//! The method to use for an equation: every classical one, judged against the true motion.
//!
//! `cargo run --release --example which_method`

use lindstedt::verify::comparison::compare;
use lindstedt::{Oscillator, Values};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
    let table = compare(&pendulum, &Values::try_from([("A", 2.0)])?, None, 0.01)?;
    if let Some(truth) = table.true_frequency {
        println!("true omega {truth:.9} at A = 2");
    }
    for row in &table.rows {
        let method = row.solution.method.name();
        match row.relative_error {
            Some(error) => {
                println!("{:+9.4} %  {method}: {}", 100.0 * error, row.solution.formula())
            }
            None => println!("no number   {method}"),
        }
    }
    for refused in &table.refused {
        println!("refused     {}: {}", refused.method.name(), refused.reason);
    }
    Ok(())
}
