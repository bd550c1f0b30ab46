"""What every room uses: names and their spelling, records, findings, bounds."""
