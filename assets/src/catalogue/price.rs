//! Prices: an amount in hundredths and a currency, exact.

use std::fmt;
use std::str::FromStr;

/// A price, as `49.90 EUR`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Price {
    /// Amount in hundredths of the currency.
    pub hundredths: u64,
    /// Code of the currency (ISO 4217): three capital letters.
    pub currency: String,
}

/// Largest amount (hundredths): what costs more is a slip of the pen.
const MOST: u64 = 100_000_000;

impl FromStr for Price {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("the price {text:?} is none; write it as \"49.90 EUR\"");
        let (amount, currency) = text.split_once(' ').ok_or_else(wrong)?;
        if currency.len() != 3 || !currency.bytes().all(|b| b.is_ascii_uppercase()) {
            return Err(wrong());
        }
        let (whole, part) = amount.split_once('.').unwrap_or((amount, "00"));
        let digits = |text: &str| !text.is_empty() && text.len() <= 9 && text.bytes().all(|b| b.is_ascii_digit());
        if !digits(whole) || !digits(part) || part.len() != 2 {
            return Err(wrong());
        }
        let number = |text: &str| text.parse::<u64>().map_err(|_| wrong());
        let hundredths = number(whole)? * 100 + number(part)?;
        if hundredths > MOST { Err(wrong()) } else { Ok(Self { hundredths, currency: currency.into() }) }
    }
}

impl fmt::Display for Price {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:02} {}", self.hundredths / 100, self.hundredths % 100, self.currency)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prices_are_exact_and_come_back_as_written() {
        for (text, hundredths) in [("49.90 EUR", 4990), ("0.05 USD", 5), ("1200.00 TRY", 120_000)] {
            let price: Price = text.parse().unwrap();
            assert_eq!((price.hundredths, price.to_string().as_str()), (hundredths, text));
        }
        assert_eq!("80 SEK".parse::<Price>().unwrap().hundredths, 8000);
    }

    #[test]
    fn what_is_no_price_is_refused() {
        for text in [
            "",
            "49.90",
            "EUR",
            "-1.00 EUR",
            "49.9 EUR",
            "49,90 EUR",
            "NaN EUR",
            "1e9 EUR",
            "9999999.00 EUR",
            "5.00 eur",
        ] {
            assert!(text.parse::<Price>().unwrap_err().contains("49.90 EUR"), "{text}");
        }
    }
}
