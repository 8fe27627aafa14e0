"""The one place that puts the rooms together: from order to certificate, without a screen."""
