"""What the data of a calibration say about themselves: residuals, outliers, drift, bias instability, the
Earth's rate. Nothing here changes a result or leaves a recording out: findings are named."""
