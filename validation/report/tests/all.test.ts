import './format.test';
import './playback.test';
import './plot_data.test';
import './report.test';
import './trade.test';
import './verdict.test';
